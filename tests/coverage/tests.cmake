# Lines of the readers that tests and corpora run (scripts/stress coverage): -DTOPPLE_COVERAGE=ON, GCC alone. Only the
# readers are counted and compiled without optimisation, so that lines are what they are; all else is as in the release.
option(TOPPLE_COVERAGE "Count which lines of the readers are run (GCC only)" OFF)
if(TOPPLE_COVERAGE)
  file(GLOB_RECURSE coverage_structure RELATIVE "${PROJECT_SOURCE_DIR}/structure"
    "${PROJECT_SOURCE_DIR}/structure/formats/*.cpp")
  # What writes models is no reader.
  list(FILTER coverage_structure EXCLUDE REGEX
    "frame3dd_(loads_)?of_model|frame3dd_write|tables_of_|generator/written_out|formats/convert|divide_cut|output_|temporary_name")
  list(APPEND coverage_structure drawn/read_drawn_meshes.cpp simulation/snapshot_file.cpp study/study_journal.cpp
    study/journal_line.cpp study/study_base.cpp study/varied_document.cpp study/analysis_options.cpp)
  set_source_files_properties(${coverage_structure} DIRECTORY "${PROJECT_SOURCE_DIR}/structure"
    PROPERTIES COMPILE_OPTIONS "--coverage;-O0")
  set_source_files_properties(gltf_reader.cpp DIRECTORY "${PROJECT_SOURCE_DIR}/fracture" PROPERTIES COMPILE_OPTIONS "--coverage;-O0")
  if(TOPPLE_VIEWER)
    set_source_files_properties(app/actions.cpp app/open_scene.cpp app/start/recent_files.cpp app/start/shipped_scenes.cpp
      DIRECTORY "${PROJECT_SOURCE_DIR}/apps/viewer" PROPERTIES COMPILE_OPTIONS "--coverage;-O0")
  endif()
endif()
