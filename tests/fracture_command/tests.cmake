find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME "topple fracture: written meshes are closed and add up, wrong files are refused"
           COMMAND Python3::Interpreter "${CMAKE_CURRENT_LIST_DIR}/check.py" "$<TARGET_FILE:topple>")
endif()
