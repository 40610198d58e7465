# The renderer and the viewer; left out where they are not built.
if(TOPPLE_VIEWER)
  topple_tests(viewer topple_viewer_app)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
  target_link_libraries(test_viewer PRIVATE PkgConfig::STB)
  target_compile_definitions(test_viewer PRIVATE TOPPLE_VIEWER_PROGRAM="$<TARGET_FILE:topple-viewer>"
    TOPPLE_PROGRAM="$<TARGET_FILE:topple>")
  add_dependencies(test_viewer topple-viewer topple)
endif()
