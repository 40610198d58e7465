# Every command that the README shows must work as it is written there.
add_test(NAME "readme: every command runs"
         COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/bin")
set_tests_properties("readme: every command runs" PROPERTIES TIMEOUT 900 SKIP_REGULAR_EXPRESSION "SKIPPED: ")
