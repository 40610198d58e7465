# The renderer and the viewer; left out where they are not built.
if(TOPPLE_VIEWER)
  topple_tests(viewer topple_renderer)
endif()
