add_test(NAME "topple analyse: an option without what it belongs to is refused by name"
         COMMAND "${CMAKE_CURRENT_LIST_DIR}/run" "$<TARGET_FILE:topple>")
