# An installed Topple must serve a stranger: install into a fresh prefix, build the consumer there with find_package, run it.
# (A sanitizer build cannot be linked into a program that is built without the sanitizers.)
if(NOT TOPPLE_SANITIZE)
  add_test(NAME "install: a consumer builds against the installed package and runs"
           COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "${PROJECT_BINARY_DIR}" "${CMAKE_CURRENT_LIST_DIR}/consumer"
                   "${PROJECT_SOURCE_DIR}/README.md")
endif()
add_test(NAME "install: no leaf library sees another layer's headers"
         COMMAND "${CMAKE_CURRENT_LIST_DIR}/check_layers" "${PROJECT_SOURCE_DIR}" "${CMAKE_CXX_COMPILER}")
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME "install: no two types of one namespace share a name"
           COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/check_types.py" "${PROJECT_SOURCE_DIR}")
endif()
