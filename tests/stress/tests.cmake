# Long runs: one program for each .cpp file, built when asked for (scripts/stress TOPIC). Each takes how much to do as its
# argument and ends with status 0 when nothing failed. A topic named after a library links that library, any other all.
file(GLOB stress_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/*.cpp")
foreach(stress_source IN LISTS stress_sources)
  get_filename_component(stress_topic "${stress_source}" NAME_WE)
  add_executable(stress_${stress_topic} EXCLUDE_FROM_ALL "${stress_source}")
  set(stress_library structure)
  if(TARGET topple::${stress_topic})
    set(stress_library ${stress_topic})
  endif()
  target_link_libraries(stress_${stress_topic} PRIVATE topple_options topple::${stress_library})
  target_include_directories(stress_${stress_topic} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/${stress_library}")
endforeach()

# A few of each kind with every run of the suite; all of them by scripts/stress hostile and scripts/stress faults.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME hostile COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/hostile.py" "$<TARGET_FILE_DIR:topple>" --cases 150)
  add_test(NAME faults COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/faults/faults.py" "$<TARGET_FILE_DIR:topple>" --short)
  set_tests_properties(faults PROPERTIES ENVIRONMENT "CXX=${CMAKE_CXX_COMPILER}")
  set_tests_properties(hostile faults PROPERTIES TIMEOUT 600)
endif()
