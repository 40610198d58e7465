# Files, code, tests and rooms that the documents name are those of the tree; their sentences are short.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME "docs: what they name is there"
           COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/check_documents.py" "${PROJECT_SOURCE_DIR}")
  add_test(NAME "docs: the page of constants is what the headers say"
           COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/scripts/constants" --check)
endif()
find_program(TOPPLE_DOXYGEN doxygen)
if(TOPPLE_DOXYGEN AND NOT TOPPLE_SANITIZE)
  add_test(NAME "docs: every public name has a comment"
           COMMAND "${PROJECT_SOURCE_DIR}/scripts/reference" "${PROJECT_BINARY_DIR}/reference")
endif()
