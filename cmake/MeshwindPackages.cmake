# Debian packages of what is installed, by cpack; cmake/packages.sh builds and calls it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "meshwind developers <meshwind@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENTS_ALL program library)

# meshwind_package(COMPONENT NAME SECTION DEPENDS WORDS)
macro(meshwind_package component name section depends words)
    string(TOUPPER ${component} upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
    set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
    set(CPACK_COMPONENT_${upper}_DESCRIPTION "${words}")
endmacro()

meshwind_package(
    program meshwind science ""
    "filament winding on triangulated mandrels\nReads a part and a machine, writes checked NC code.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "meshwind-cad, python3-meshwind")
# What meshwindConfig.cmake looks for.
meshwind_package(
    library libmeshwind-dev libdevel
    "libassimp-dev, libcgal-dev, libeigen3-dev, libembree-dev, libflann-dev, libglpk-dev, libopenmesh-dev, libpng-dev, libtbb-dev, nettle-dev, nlohmann-json3-dev, zlib1g-dev"
    "filament winding on triangulated mandrels, libraries\nThe main job in memory, for C++.")
if(TARGET meshwind_cad)
    list(APPEND CPACK_COMPONENTS_ALL cad)
    meshwind_package(
        cad meshwind-cad science "meshwind (= ${PROJECT_VERSION})"
        "filament winding on triangulated mandrels, CAD files\nLets meshwind read STEP, IGES and BREP, by Open CASCADE.")
endif()
if(TARGET meshwind_python)
    list(APPEND CPACK_COMPONENTS_ALL python)
    meshwind_package(
        python python3-meshwind python "meshwind (= ${PROJECT_VERSION}), python3, python3-numpy"
        "filament winding on triangulated mandrels, Python module\nRuns, paths and layers as arrays.")
endif()
include(CPack)
