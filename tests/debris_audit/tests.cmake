# What measures debris from outside goes on building against the interface of the collision library alone.
add_test(NAME "debris audit: builds against the library, and a stack stands on its ground"
         COMMAND bash "${CMAKE_CURRENT_LIST_DIR}/check.sh" "${PROJECT_SOURCE_DIR}" "${CMAKE_BINARY_DIR}")
set_tests_properties("debris audit: builds against the library, and a stack stands on its ground"
                     PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 300)
