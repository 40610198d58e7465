if(TARGET topple_man_pages)
  add_test(NAME "packaging: manual pages and completion are those of the help"
           COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "${PROJECT_BINARY_DIR}/man" "${PROJECT_SOURCE_DIR}/models"
                   "$<TARGET_FILE:topple>")
endif()
