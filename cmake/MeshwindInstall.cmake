include(CMakePackageConfigHelpers)

set(meshwind_targets meshwind_core meshwind_mesh meshwind_geodesic meshwind_winding meshwind_machines
                     meshwind_postproc meshwind_study meshwind_pipeline meshwind_report meshwind_page)
install(
    TARGETS ${meshwind_targets}
    EXPORT meshwindTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshwind)
install(TARGETS meshwind_umbrella EXPORT meshwindTargets)
if(MESHWIND_PROGRAM)
    install(TARGETS meshwind_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(FILES ${PROJECT_SOURCE_DIR}/docs/meshwind.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(
        FILES ${PROJECT_SOURCE_DIR}/cli/meshwind.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME meshwind)
endif()
# The meshes and machines that bare names on the command line stand for.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data DESTINATION ${CMAKE_INSTALL_DATADIR}/meshwind OPTIONAL)
install(
    DIRECTORY ${PROJECT_SOURCE_DIR}/machines
    DESTINATION ${CMAKE_INSTALL_DATADIR}/meshwind
    FILES_MATCHING
    PATTERN "*.json"
    PATTERN "*.stl")
install(
    EXPORT meshwindTargets
    NAMESPACE meshwind::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind)
configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/meshwindConfig.cmake.in ${PROJECT_BINARY_DIR}/meshwindConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/meshwindConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/meshwindConfig.cmake ${PROJECT_BINARY_DIR}/meshwindConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindGLPK.cmake ${CMAKE_CURRENT_LIST_DIR}/FindNettle.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind)
