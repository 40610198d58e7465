# Every command that the README shows is run as it stands there. (Under the sanitizers it would only take longer.)
if(NOT TOPPLE_SANITIZE)
  add_test(NAME "readme: every command runs"
           COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/bin")
  set_tests_properties("readme: every command runs" PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 900)
endif()
