# meshwind_library(NAME HEADERS ... SOURCES ... PUBLIC ... PRIVATE ...): one static library per folder.
function(meshwind_library name)
    cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
    set(target meshwind_${name})
    add_library(${target} STATIC)
    add_library(meshwind::${name} ALIAS ${target})
    target_sources(${target} PRIVATE ${ARG_SOURCES})
    target_sources(
        ${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    target_compile_features(${target} PUBLIC cxx_std_20)
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    meshwind_flags(${target})
endfunction()

# Warnings, reproducible arithmetic, sanitizers and the common headers for a target of this project.
function(meshwind_flags target)
    meshwind_compile_flags(${target})
    if(MESHWIND_PCH STREQUAL "all")
        meshwind_use_precompiled(${target} meshwind_pch)
    endif()
endfunction()

# A source file then compiles although it forgets to include what it uses: ./test.sh builds the library without.
function(meshwind_use_precompiled target from)
    target_precompile_headers(${target} REUSE_FROM ${from})
    # Out of such headers joined strings make GCC 12 warn falsely. The address sanitizer checks the same.
    target_compile_options(
        ${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-restrict>")
endfunction()

# meshwind_precompile(TARGET HEADER ...): headers of other projects that nearly every source file reads, compiled once.
function(meshwind_precompile target)
    file(TOUCH ${CMAKE_BINARY_DIR}/pch.cpp)
    add_library(${target} OBJECT ${CMAKE_BINARY_DIR}/pch.cpp)
    target_link_libraries(${target} PRIVATE Eigen3::Eigen)
    target_precompile_headers(
        ${target} PRIVATE <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <set> <span>
        <string> <vector> <Eigen/Core> <Eigen/Geometry> ${ARGN})
    meshwind_compile_flags(${target})
endfunction()

function(meshwind_compile_flags target)
    target_compile_options(
        ${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off
                          $<$<BOOL:${MESHWIND_WERROR}>:-Werror>)
    if(MESHWIND_SANITIZE)
        # Without the checks of every access through a pointer, which double the time to build code that
        # uses Eigen: the address sanitizer sees what is out of bounds, null included.
        target_compile_options(
            ${target}
            PRIVATE -fsanitize=${MESHWIND_SANITIZE} -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow
                    -fno-sanitize-recover=all -fno-omit-frame-pointer)
        target_link_options(${target} PUBLIC -fsanitize=${MESHWIND_SANITIZE})
    endif()
endfunction()
