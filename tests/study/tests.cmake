# The command as a whole; on ranks as well where the program was built for them.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(mpirun "")
  if(TOPPLE_MPI)
    find_program(TOPPLE_MPIRUN mpirun REQUIRED)
    set(mpirun "${TOPPLE_MPIRUN}")
  endif()
  add_test(NAME "topple study: the same journal whatever computes it, and after it was killed"
           COMMAND Python3::Interpreter "${CMAKE_CURRENT_LIST_DIR}/check.py" "$<TARGET_FILE:topple>" ${mpirun})
endif()
