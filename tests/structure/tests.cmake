# The tests of one folder by themselves, test_structure_FOLDER, for builds in which all of them would take too long
# (.ci/run takes one of them a day under the sanitizers).
file(GLOB structure_folders LIST_DIRECTORIES true CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/*")
foreach(structure_folder IN LISTS structure_folders)
  get_filename_component(structure_part "${structure_folder}" NAME)
  file(GLOB structure_sources CONFIGURE_DEPENDS "${structure_folder}/*_test.cpp")
  if(structure_sources)
    add_executable(test_structure_${structure_part} EXCLUDE_FROM_ALL ${structure_sources})
    topple_group_tests(test_structure_${structure_part})
    target_link_libraries(test_structure_${structure_part} PRIVATE topple_options topple_test_main topple::structure)
    target_include_directories(test_structure_${structure_part} PRIVATE "${PROJECT_SOURCE_DIR}/structure" "${CMAKE_CURRENT_LIST_DIR}")
  endif()
endforeach()
