# meshwind_library(NAME HEADERS ... INTERNAL ... SOURCES ... PUBLIC ... PRIVATE ...): one static library per folder. HEADERS are
# installed, INTERNAL are the other headers; tests/tools/check_public.py holds which are which.
function(meshwind_library name)
    cmake_parse_arguments(ARG "" "" "HEADERS;INTERNAL;SOURCES;PUBLIC;PRIVATE" ${ARGN})
    set(target meshwind_${name})
    add_library(${target} STATIC)
    add_library(meshwind::${name} ALIAS ${target})
    target_sources(${target} PRIVATE ${ARG_INTERNAL} ${ARG_SOURCES})
    target_sources(
        ${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    meshwind_flags(${target})
    if(MESHWIND_UNITY GREATER 1)
        meshwind_note_names(${ARG_HEADERS} ${ARG_INTERNAL})
        meshwind_unity(${target} ${ARG_SOURCES})
    endif()
endfunction()

# meshwind_unity(TARGET SOURCE ...): several sources are compiled as one text, which takes half the time. No text has a source
# that defines a name, in its anonymous namespace mostly, and another in which that name stands: each means by its names what
# it means by itself, and results have the same digits (.ci/run golden). A source with a name of a header that it does not
# include stays by itself. The names are read here, so that CMake has to run again after a change of sources; ./meshwind and
# ./test.sh see to that.
function(meshwind_unity target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # Variables may be called like another source's constants; only sources by themselves are main files.
    target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    set(groups 0)
    foreach(source ${ARGN})
        file(READ ${source} text)
        # Each as long to compile as several others.
        if(NOT source MATCHES "\\.cpp$" OR text MATCHES "#include <(CGAL|flann|regex)")
            continue()
        endif()
        meshwind_names_in("${text}" defined used)
        string(REGEX MATCHALL "#include \"[^\"]*" includes "${text}")
        list(TRANSFORM includes REPLACE "^.*\"" "")
        set(alone OFF)
        foreach(name ${defined})
            get_property(headers GLOBAL PROPERTY MESHWIND_HEADERS_WITH_${name})
            set(not_included "${headers}")
            list(REMOVE_ITEM not_included "" ${includes})
            if(headers AND not_included STREQUAL headers)  # the name is another one there
                set(alone ON)
                break()
            endif()
        endforeach()
        if(alone)
            continue()
        endif()
        set(group 0)
        while(group LESS groups)
            set(fits ON)
            foreach(name ${defined})
                if(DEFINED used_${group}_${name})
                    set(fits OFF)
                    break()
                endif()
            endforeach()
            foreach(name ${used})
                if(DEFINED defined_${group}_${name})
                    set(fits OFF)
                    break()
                endif()
            endforeach()
            if(fits AND count_${group} LESS MESHWIND_UNITY)
                break()
            endif()
            math(EXPR group "${group} + 1")
        endwhile()
        if(group EQUAL groups)
            math(EXPR groups "${groups} + 1")
            set(count_${group} 0)
        endif()
        math(EXPR count_${group} "${count_${group}} + 1")
        foreach(name ${defined})
            set(defined_${group}_${name} ON)
        endforeach()
        foreach(name ${used})
            set(used_${group}_${name} ON)
        endforeach()
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    endforeach()
endfunction()

# meshwind_note_names(HEADER ...): which names they declare.
function(meshwind_note_names)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    foreach(header ${ARGN})
        file(READ ${header} text)
        if(text MATCHES "\nnamespace meshwind::")  # behind that name
            continue()
        endif()
        string(REPLACE "[[nodiscard]] " "" text "${text}")
        meshwind_names_in("${text}" declared used)
        foreach(name ${declared})
            set_property(GLOBAL APPEND PROPERTY MESHWIND_HEADERS_WITH_${name} ${folder}/${header})
        endforeach()
    endforeach()
endfunction()

# Names that a source defines at the start of a line (types, and functions and constants behind their types; members of
# classes have "::" instead), and all types, constants and calls in it but those of comments and members.
function(meshwind_names_in text defined_in used_in)
    string(REGEX REPLACE "(//|#)[^\n]*" "" text "\n${text}")
    string(REGEX REPLACE "[][;]" "=" text "${text}")
    string(REGEX MATCHALL "\n(struct|class|enum class|enum) [A-Za-z0-9_]+" types "${text}")
    string(REGEX MATCHALL "\nusing [A-Za-z0-9_]+ =" aliases "${text}")
    string(REGEX MATCHALL "\n[A-Za-z][A-Za-z0-9_:<>,&* ]*[A-Za-z0-9_>&*] [&*]?[A-Za-z0-9_]+ ?[({=]" others "${text}")
    list(FILTER others EXCLUDE REGEX "^\n(using|namespace|struct|class|enum) ")
    set(defined ${types} ${aliases} ${others})
    list(TRANSFORM defined REPLACE " ?[({=]$" "")
    list(TRANSFORM defined REPLACE "^.*[ &*\n]" "")
    list(REMOVE_DUPLICATES defined)
    string(REGEX REPLACE "[.>:][A-Za-z0-9_]+" "" text "${text}")
    string(REGEX MATCHALL "k?[A-Z][A-Za-z0-9_]*|[a-z_][a-z0-9_]*\\(" used "${text}")
    list(TRANSFORM used REPLACE "\\($" "")
    list(REMOVE_DUPLICATES used)
    set(${defined_in} ${defined} PARENT_SCOPE)
    set(${used_in} ${used} PARENT_SCOPE)
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
endfunction()

# meshwind_precompile(TARGET HEADER ...): headers of other projects that nearly every source file reads, compiled once.
function(meshwind_precompile target)
    if(NOT EXISTS ${PROJECT_BINARY_DIR}/pch.cpp)  # else it would be compiled anew
        file(TOUCH ${PROJECT_BINARY_DIR}/pch.cpp)
    endif()
    add_library(${target} OBJECT ${PROJECT_BINARY_DIR}/pch.cpp)
    target_link_libraries(${target} PRIVATE Eigen3::Eigen)
    target_precompile_headers(
        ${target} PRIVATE <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <set> <span>
        <string> <vector> <Eigen/Core> <Eigen/Geometry> ${ARGN})
    meshwind_compile_flags(${target})
endfunction()

# Without fused multiply-add: the same digits on every x86-64 machine. Nobody reads what mathematical functions leave in
# errno, or floating-point exceptions: without them -O3 makes the main job 6 % faster and changes no digit.
#
# NDEBUG is taken away again on purpose, where CMake's release types or a project around this one define it: assertions hold
# in Release too, and end a run as an internal error instead of a wrong program. Eigen's stand in inner loops: off, but in
# Debug. Headers have no assertions, so that a program built with NDEBUG and a library built without mean the same by them.
function(meshwind_compile_flags target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    # The libraries are for the Python module too. Nobody puts another function in the place of one of ours: code without
    # that freedom is as fast as that of a program alone.
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "EXECUTABLE")  # the same code, for common headers that are compiled once for both
        target_compile_options(${target} PRIVATE -fPIC)
    else()
        set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
    target_compile_options(
        ${target} PRIVATE "$<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-fno-math-errno;-fno-trapping-math;-UNDEBUG>")
    target_compile_definitions(${target} PRIVATE $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:EIGEN_NO_DEBUG>)
    target_compile_options(
        ${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off
                          $<$<BOOL:${MESHWIND_WERROR}>:-Werror>)
    # In kB. GCC looks for free memory when it has taken 128 MB, and again and again: a tenth of its time.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=600000>)
    # GCC 12 warns falsely of joined strings and unrolled loops. Clang and the address sanitizer check the same.
    target_compile_options(
        ${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-restrict>")
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
