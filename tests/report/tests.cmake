# The HTML report in headless Chromium, as a person would use it. Left out where the page cannot be built (no npm), and in
# sanitizer builds: what is tested is the page.
if(TARGET topple_web AND NOT TOPPLE_SANITIZE)
  add_test(NAME "report: opens, turns and switches results in a browser"
           COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "$<TARGET_FILE:topple>" "${PROJECT_SOURCE_DIR}"
                   "${PROJECT_BINARY_DIR}/apps/web/work")
  set_tests_properties("report: opens, turns and switches results in a browser" PROPERTIES
                       SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 600)
  find_package(Python3 COMPONENTS Interpreter)
  if(Python3_FOUND)
    set(programs "$<TARGET_FILE:topple>")
    if(TOPPLE_VIEWER)
      list(APPEND programs "$<TARGET_FILE:topple-viewer>")
    endif()
    add_test(NAME "report: names that are HTML stay text on every page"
             COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/hostile_names.py" ${programs})
    set_tests_properties("report: names that are HTML stay text on every page" PROPERTIES TIMEOUT 900)
  endif()
endif()
