# Debian packages by CPack: topple (programs, models), libtopple-dev (libraries, headers), python3-topple. scripts/package
# builds them, checks them with lintian, and tries them in a fresh system.
if(NOT UNIX OR APPLE)
  return()
endif()

# What Debian asks of every package: its licence, its changes.
set(documents "${PROJECT_BINARY_DIR}/documents")
file(READ LICENSE licence)
file(READ THIRD-PARTY.md third_party)
file(WRITE "${documents}/copyright"
  "${licence}\n${third_party}\nOn Debian systems the GNU licences are in /usr/share/common-licenses/GPL-2 and LGPL-2.1, the Apache "
  "License 2.0 in /usr/share/common-licenses/Apache-2.0, the Mozilla Public License 2.0 in /usr/share/common-licenses/MPL-2.0.\n")
find_program(TOPPLE_GZIP gzip)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME topple)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_COMPONENTS_ALL topple development python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")

# First line: the synopsis; the rest becomes the extended description.
set(about "Topple analyses frames and panels by a direct solver, breaks joints where\nthe load path says, and lets what falls be rigid bodies.\n\n")
set(CPACK_DEBIAN_TOPPLE_PACKAGE_NAME topple)
set(CPACK_COMPONENT_TOPPLE_DESCRIPTION 
  "static analysis and interactive demolition of buildings\n${about}This package has the command line, the viewer, and models.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtopple-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libsuitesparse-dev, libopenblas-dev, libmetis-dev, libbullet-dev, libtinygltf-dev, libnlopt-cxx-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "topple")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION 
  "libraries to analyse and demolish buildings\n${about}This package has the static libraries and headers, and what CMake\nneeds to find them.")
if(TARGET topple_python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-topple)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "topple, python3-matplotlib")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION 
    "Python module to analyse and demolish buildings\n${about}This package has the module topple, whose answers are numpy arrays.")
else()
  list(REMOVE_ITEM CPACK_COMPONENTS_ALL python)
endif()

if(TOPPLE_GZIP)
  file(WRITE "${documents}/changes"
    "topple (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n  * changelog.gz says what changed.\n\n")
  string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(APPEND "${documents}/changes" " -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")
  file(REMOVE "${documents}/changelog.Debian.gz" "${documents}/changelog.gz")
  execute_process(COMMAND "${TOPPLE_GZIP}" -9nc "${documents}/changes" OUTPUT_FILE "${documents}/changelog.Debian.gz")
  execute_process(COMMAND "${TOPPLE_GZIP}" -9nc "${PROJECT_SOURCE_DIR}/CHANGELOG.md" OUTPUT_FILE "${documents}/changelog.gz")
  foreach(pair "topple topple" "development libtopple-dev" "python python3-topple")
    string(REPLACE " " ";" pair "${pair}")
    list(GET pair 0 component)
    list(GET pair 1 package)
    if(component IN_LIST CPACK_COMPONENTS_ALL)
      install(FILES "${documents}/copyright" "${documents}/changelog.gz" "${documents}/changelog.Debian.gz"
              DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${package}" COMPONENT ${component})
    endif()
  endforeach()
endif()
include(CPack)
