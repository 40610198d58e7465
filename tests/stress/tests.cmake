# Long runs: one program for each .cpp file, built when asked for (scripts/stress TOPIC). Each takes how much to do as its
# argument and ends with status 0 when nothing failed. A topic named after a library links that library, any other all.
file(GLOB stress_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/*.cpp")
foreach(stress_source IN LISTS stress_sources)
  get_filename_component(stress_topic "${stress_source}" NAME_WE)
  add_executable(stress_${stress_topic} EXCLUDE_FROM_ALL "${stress_source}")
  set(stress_library structure)
  if(TARGET topple::${stress_topic})
    set(stress_library ${stress_topic})
  endif()
  target_link_libraries(stress_${stress_topic} PRIVATE topple_options topple::${stress_library})
  target_include_directories(stress_${stress_topic} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/${stress_library}")
endforeach()

# Tests of what runs on threads of its own: scripts/stress threads, under the thread sanitizer. The solver and what of the
# structure and the viewer threads share is compiled for it; what only computes is as in the release.
option(TOPPLE_WATCH_THREADS "The thread sanitizer in what has threads (link with -fsanitize=thread)" OFF)
if(TOPPLE_WATCH_THREADS)
  function(watch_threads folder)  # FOLDER of a target, PATTERN...
    list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/${folder}/")
    file(GLOB_RECURSE watched ${ARGN})
    set_source_files_properties(${watched} DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}"
      PROPERTIES COMPILE_OPTIONS "-fsanitize=thread;-g1;-O1")
  endfunction()
  watch_threads(solver *.cpp)
  watch_threads(structure parallel/*.cpp simulation/*.cpp standing/*.cpp study/*.cpp)
  if(TOPPLE_VIEWER)
    watch_threads(apps/viewer app/driver.cpp app/session.cpp renderer/recording.cpp renderer/snapshot*.cpp)
  endif()
endif()
# threads_tests(NAME LIBRARY TEST...): tests of other folders by themselves.
function(threads_tests name library)
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE files)
  add_executable(${name} EXCLUDE_FROM_ALL ${files})
  target_link_libraries(${name} PRIVATE topple_options topple_test_main topple::${library})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/${library}" "${CMAKE_CURRENT_SOURCE_DIR}/${library}")
  if(TOPPLE_WATCH_THREADS)
    target_compile_options(${name} PRIVATE -fsanitize=thread -g1)
  endif()
endfunction()
threads_tests(test_solver_threads solver solver/multifrontal_test.cpp solver/factor_refresh_test.cpp solver/kept_equations_test.cpp
              solver/parallel_for_test.cpp)
threads_tests(test_structure_threads structure structure/simulation/pacer_test.cpp structure/simulation/snapshot_test.cpp
  structure/simulation/simulation_motion_test.cpp structure/standing/limits_and_charges_test.cpp structure/study/journal_test.cpp)
if(TOPPLE_VIEWER)
  add_executable(test_driver_threads EXCLUDE_FROM_ALL "${CMAKE_CURRENT_SOURCE_DIR}/viewer/drawing_and_stepping_test.cpp")
  target_link_libraries(test_driver_threads PRIVATE topple_options topple_test_main topple_viewer_app)
endif()

# A few of each kind with every run of the suite; all of them by scripts/stress hostile and scripts/stress faults.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME hostile COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/hostile.py" "$<TARGET_FILE_DIR:topple>" --cases 150)
  add_test(NAME faults COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/faults/faults.py" "$<TARGET_FILE_DIR:topple>" --short)
  add_test(NAME "runs into one folder at the same time" COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/together.py" "$<TARGET_FILE:topple>")
  add_test(NAME "collapses have the same bits with the BLAS kernels of other processors"
    COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_LIST_DIR}/blas_kernels.py" "$<TARGET_FILE:topple>")
  set_tests_properties(faults PROPERTIES ENVIRONMENT "CXX=${CMAKE_CXX_COMPILER}")
  set_tests_properties(hostile faults PROPERTIES TIMEOUT 600)
endif()
