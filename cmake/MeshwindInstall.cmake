include(CMakePackageConfigHelpers)

set(meshwind_targets meshwind_core meshwind_mesh meshwind_geodesic meshwind_winding meshwind_machines
                     meshwind_postproc meshwind_study meshwind_pipeline meshwind_report meshwind_page)
install(
    TARGETS ${meshwind_targets}
    EXPORT meshwindTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/meshwind COMPONENT library)
install(TARGETS meshwind_umbrella EXPORT meshwindTargets COMPONENT library)
if(MESHWIND_PROGRAM)
    install(TARGETS meshwind_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
    install(
        FILES ${PROJECT_SOURCE_DIR}/docs/meshwind.1
        DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
        COMPONENT program)
    install(
        FILES ${PROJECT_SOURCE_DIR}/cli/meshwind.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        COMPONENT program
        RENAME meshwind)
endif()
# Where FreeCAD looks for workbenches that packages bring.
install(
    DIRECTORY ${PROJECT_SOURCE_DIR}/python/freecad/Meshwind
    DESTINATION ${CMAKE_INSTALL_DATADIR}/freecad/Mod
    COMPONENT program
    FILES_MATCHING
    PATTERN "*.py")
# The meshes and machines that bare names on the command line stand for.
install(
    DIRECTORY ${PROJECT_SOURCE_DIR}/data
    DESTINATION ${CMAKE_INSTALL_DATADIR}/meshwind
    COMPONENT program
    OPTIONAL)
install(
    DIRECTORY ${PROJECT_SOURCE_DIR}/machines
    DESTINATION ${CMAKE_INSTALL_DATADIR}/meshwind
    COMPONENT program
    FILES_MATCHING
    PATTERN "*.json"
    PATTERN "*.stl")
install(
    EXPORT meshwindTargets
    NAMESPACE meshwind::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind
    COMPONENT library)
configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/meshwindConfig.cmake.in ${PROJECT_BINARY_DIR}/meshwindConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/meshwindConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/meshwindConfig.cmake ${PROJECT_BINARY_DIR}/meshwindConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindGLPK.cmake ${CMAKE_CURRENT_LIST_DIR}/FindNettle.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/meshwind
        COMPONENT library)
