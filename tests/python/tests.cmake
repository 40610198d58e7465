# The Python package, by pytest: one test for each file, so that they run side by side.
if(TARGET topple_python)
  file(GLOB python_tests CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/test_*.py")
  foreach(file IN LISTS python_tests)
    get_filename_component(name "${file}" NAME_WE)
    add_test(NAME "python:${name}"
             COMMAND "${Python_EXECUTABLE}" -B -m pytest -q -p no:cacheprovider "${file}")
    set_tests_properties("python:${name}" PROPERTIES TIMEOUT 600
      ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;TOPPLE_BIN=${PROJECT_BINARY_DIR}/bin;MPLBACKEND=Agg")
  endforeach()
endif()
