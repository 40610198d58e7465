# What the benchmarks measure with: the reference in extended precision, debris, and the comparison of stored results.
if(TOPPLE_BENCHMARKS)
  topple_tests(benchmarks topple::solver bench_confidence bench_debris_measures)
  find_package(Python3 COMPONENTS Interpreter)
  if(Python3_FOUND)
    add_test(NAME benchmark_harness COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/check_harness.py"
             "${PROJECT_SOURCE_DIR}" "$<TARGET_FILE:topple>")
  endif()
endif()
