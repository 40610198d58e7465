# The renderer and the viewer; left out where they are not built.
if(TOPPLE_VIEWER)
  pkg_check_modules(IMGUI REQUIRED imgui)
  set_source_files_properties("${CMAKE_CURRENT_LIST_DIR}/start_page_test.cpp" "${CMAKE_CURRENT_LIST_DIR}/scale_test.cpp" PROPERTIES INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIRS}")
  topple_tests(viewer topple_viewer_app)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
  target_link_libraries(test_viewer PRIVATE PkgConfig::STB)
  target_compile_definitions(test_viewer PRIVATE TOPPLE_VIEWER_PROGRAM="$<TARGET_FILE:topple-viewer>"
    TOPPLE_PROGRAM="$<TARGET_FILE:topple>")
  add_dependencies(test_viewer topple-viewer topple)

  find_package(Python3 COMPONENTS Interpreter)
  if(Python3_FOUND)
    add_test(NAME "viewer: a run that uses everything has no OpenGL error and leaks nothing"
             COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/use_everything.py" "$<TARGET_FILE:topple-viewer>"
                     "${PROJECT_SOURCE_DIR}" "$<$<BOOL:${TOPPLE_REPLAY_PAGE}>:--replay>")
    set_tests_properties("viewer: a run that uses everything has no OpenGL error and leaks nothing" PROPERTIES
                         SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 900)
  endif()
endif()
