# The JSON Schemas hold what the documents show, what ships, and what the programs write. Skipped without python3-jsonschema.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME schemas COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/check_schemas.py"
                                "${PROJECT_SOURCE_DIR}" "$<TARGET_FILE:topple>")
  set_tests_properties(schemas PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 120)
endif()
