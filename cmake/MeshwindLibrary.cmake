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
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
    meshwind_flags(${target})
endfunction()

# Warnings, reproducible arithmetic and sanitizers for a target of this project.
function(meshwind_flags target)
    target_compile_options(
        ${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off
                          $<$<BOOL:${MESHWIND_WERROR}>:-Werror>)
    if(MESHWIND_SANITIZE)
        # GCC sees reads of uninitialised memory in instrumented library code where there are none;
        # the builds without sanitizers keep that warning.
        target_compile_options(
            ${target} PRIVATE -fsanitize=${MESHWIND_SANITIZE} -fno-sanitize-recover=all
                              -fno-omit-frame-pointer -Wno-maybe-uninitialized)
        target_link_options(${target} PUBLIC -fsanitize=${MESHWIND_SANITIZE})
    endif()
endfunction()
