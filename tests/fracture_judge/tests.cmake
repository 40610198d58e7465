# CGAL judges unions of polygons and constrained triangulations. Its packages for that are under the GPL, so it judges only where such code may be called.
find_package(CGAL QUIET)
if(CGAL_FOUND AND TOPPLE_GPL)
  add_executable(test_fracture_judge "${CMAKE_CURRENT_LIST_DIR}/union_test.cpp"
                 "${CMAKE_CURRENT_LIST_DIR}/constrained_delaunay_test.cpp")
  target_link_libraries(test_fracture_judge PRIVATE topple_options topple_test_main topple::fracture CGAL::CGAL)
  target_include_directories(test_fracture_judge PRIVATE "${PROJECT_SOURCE_DIR}/fracture")
  target_compile_options(test_fracture_judge PRIVATE -w -frounding-math)  # CGAL's headers, not ours
  catch_discover_tests(test_fracture_judge TEST_PREFIX "fracture:" PROPERTIES TIMEOUT 600)
endif()
