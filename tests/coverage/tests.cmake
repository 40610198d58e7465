# Lines of the readers that tests and corpora run (scripts/stress coverage): -DTOPPLE_COVERAGE=ON, GCC alone. Only the
# readers are counted and compiled without optimisation, so that lines are what they are; all else is as in the release.
option(TOPPLE_COVERAGE "Count which lines of the readers are run (GCC only)" OFF)
if(TOPPLE_COVERAGE)
  # count_lines(FOLDER FILE...): files of the target that is made in FOLDER.
  function(count_lines folder)
    list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/${folder}/")
    foreach(file IN LISTS ARGN)
      if(NOT EXISTS "${file}")
        message(FATAL_ERROR "coverage: there is no ${file}")
      endif()
    endforeach()
    set_source_files_properties(${ARGN} DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}" PROPERTIES COMPILE_OPTIONS "--coverage;-O0")
  endfunction()
  file(GLOB_RECURSE readers RELATIVE "${PROJECT_SOURCE_DIR}/structure" "${PROJECT_SOURCE_DIR}/structure/formats/*.cpp")
  # What writes models is no reader.
  list(FILTER readers EXCLUDE REGEX
    "frame3dd_(loads_)?of_model|frame3dd_write|tables_of_|written_out|formats/convert|divide_cut|output_|temporary_name")
  count_lines(structure ${readers} visual/read_drawn_meshes.cpp simulation/snapshot_file.cpp study/study_journal.cpp
    study/journal_line.cpp study/study_base.cpp study/varied_document.cpp study/analysis_options.cpp)
  count_lines(fracture gltf_reader.cpp)
  target_sources(topple PRIVATE "${CMAKE_CURRENT_LIST_DIR}/count_at_quick_exit.cpp")
  if(TOPPLE_VIEWER)
    count_lines(apps/viewer app/actions.cpp app/open_scene.cpp app/start/recent_files.cpp app/start/shipped_scenes.cpp)
  endif()
endif()
