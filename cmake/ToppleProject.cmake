# Settings that every target of Topple shares, and the function that makes a library of one folder.

include(GNUInstallDirs)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")  # the dense kernels are BLAS's; -O3 only compiles longer
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

find_program(TOPPLE_CCACHE ccache)
if(TOPPLE_CCACHE)  # paths below the checkout count as relative: what one checkout has compiled serves another
  set(CMAKE_CXX_COMPILER_LAUNCHER
    "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "${TOPPLE_CCACHE}")
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)

# What the compiler is told for our own code. No contraction: a fused multiply-add would give other bits on
# another processor or at another optimisation level, and replays must not depend on either.
add_library(topple_options INTERFACE)
option(TOPPLE_UNITY "Compile sources in groups: faster from nothing, slower after a small change" OFF)
target_compile_options(topple_options INTERFACE -Wall -Wextra -Wnon-virtual-dtor -ffp-contract=off
  # Between files that are compiled as one these two mean nothing; a build without groups has them.
  $<IF:$<BOOL:${TOPPLE_UNITY}>,-Wno-subobject-linkage,-Wshadow>
  # GCC 12 warns of overlapping copies inside std::string where there are none (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(TOPPLE_SANITIZE)
  add_compile_options(-fsanitize=${TOPPLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${TOPPLE_SANITIZE})
endif()

# How libraries write the state of a running computation (solver/archive): a header alone, beside all layers.
add_library(topple_archive INTERFACE)
target_include_directories(topple_archive SYSTEM INTERFACE "${PROJECT_SOURCE_DIR}/solver/archive")

# topple_next_group(VARIABLE NAME): VARIABLE becomes the group that the next source of NAME comes into, NAME_0 first and
# eight in each; what came before is counted in the caller's count_NAME.
macro(topple_next_group variable name)
  if(NOT DEFINED count_${name})
    set(count_${name} 0)
  endif()
  math(EXPR ${variable} "${count_${name}} / 8")
  set(${variable} "${name}_${${variable}}")
  math(EXPR count_${name} "${count_${name}} + 1")
endmacro()

# topple_group_sources(TARGET): with TOPPLE_UNITY up to eight sources of one folder are compiled as one, so that the
# headers of all eight (which take most of the time) are read once. Private names must then be unique in their folder.
function(topple_group_sources target)
  if(NOT TOPPLE_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" DIRECTORY)
    file(RELATIVE_PATH folder "${CMAKE_CURRENT_SOURCE_DIR}" "${folder}")
    string(MAKE_C_IDENTIFIER "${folder}" name)
    topple_next_group(group "${name}")
    set_property(SOURCE "${source}" PROPERTY UNITY_GROUP "${group}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# topple_library(NAME [PUBLIC_LINK ...] [PRIVATE_LINK ...])
# The folder's .cpp files (and those of its sub-folders) become topple_NAME, alias topple::NAME. Public headers lie in
# include/topple/NAME and are all that other targets see; private ones lie beside their .cpp.
function(topple_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC_LINK;PRIVATE_LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  add_library(topple_${name} STATIC ${sources})
  add_library(topple::${name} ALIAS topple_${name})
  topple_group_sources(topple_${name})
  set_target_properties(topple_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(topple_${name}
    PUBLIC "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>"
           "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
    PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  target_compile_features(topple_${name} PUBLIC cxx_std_20)
  target_link_libraries(topple_${name}
    PUBLIC Eigen3::Eigen ${ARG_PUBLIC_LINK}
    PRIVATE $<BUILD_INTERFACE:topple_options> $<BUILD_INTERFACE:topple_archive> ${ARG_PRIVATE_LINK})
  install(TARGETS topple_${name} EXPORT topple ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
  install(DIRECTORY include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
endfunction()
