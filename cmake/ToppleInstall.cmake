# Install rules of the package as a whole: find_package(topple) finds topple::solver, topple::collision,
# topple::fracture and topple::structure.

include(CMakePackageConfigHelpers)

set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/topple")
install(EXPORT topple NAMESPACE topple:: FILE topple-targets.cmake DESTINATION "${config_dir}"
        COMPONENT development)
configure_package_config_file(cmake/topple-config.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/topple-config.cmake"
                              INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/topple-config-version.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/topple-config.cmake"
              "${CMAKE_CURRENT_BINARY_DIR}/topple-config-version.cmake"
              cmake/FindCHOLMOD.cmake cmake/FindMETIS.cmake cmake/FindBulletDouble.cmake
              cmake/FindNLopt.cmake
        DESTINATION "${config_dir}" COMPONENT development)
install(FILES LICENSE THIRD-PARTY.md SECURITY.md DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/topple" COMPONENT topple)
install(DIRECTORY models schemas DESTINATION "${CMAKE_INSTALL_DATADIR}/topple" COMPONENT topple)
