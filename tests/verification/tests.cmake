# Published answers, each at the accuracy it is owed; the table that the program prints is the one in docs/verification.md.
topple_tests(verification topple::structure)
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME verification_document COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/check_document.py"
           "$<TARGET_FILE:test_verification>" "${PROJECT_SOURCE_DIR}/docs/verification.md")
endif()
