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
