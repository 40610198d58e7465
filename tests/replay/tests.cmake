# The replay page in headless Chromium, as a person would use it. Left out where the page cannot be built (no npm), and in
# sanitizer builds: what is tested is the page.
if(TARGET topple_web AND TARGET topple-viewer AND NOT TOPPLE_SANITIZE)
  add_test(NAME "replay: plays, scrubs and turns in a browser"
           COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "$<TARGET_FILE:topple-viewer>" "${PROJECT_SOURCE_DIR}"
                   "${PROJECT_BINARY_DIR}/apps/web/work")
  set_tests_properties("replay: plays, scrubs and turns in a browser" PROPERTIES
                       SKIP_REGULAR_EXPRESSION "SKIPPED: " TIMEOUT 600)
endif()
