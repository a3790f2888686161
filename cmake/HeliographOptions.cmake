# Compile options every target of the project shares: warnings, float rules, sanitizers, build type.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_EXTENSIONS OFF)

add_library(heliograph_options INTERFACE)
target_compile_options(heliograph_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow
    # GCC 12 warns of overlap in every optimised "literal" + std::string (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # In one source made of several, a class that uses what its own file keeps to itself is no error.
    $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
    # Kernels' functions are shared with C++: the same source must round the same way everywhere.
    -ffp-contract=off)
if(HELIOGRAPH_WERROR)
    target_compile_options(heliograph_options INTERFACE -Werror)
endif()
if(HELIOGRAPH_SANITIZE)
    target_compile_options(heliograph_options INTERFACE
        -fsanitize=${HELIOGRAPH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
        # GCC 12 takes the instrumented std::regex for uninitialised.
        -Wno-maybe-uninitialized)
    target_link_options(heliograph_options INTERFACE -fsanitize=${HELIOGRAPH_SANITIZE})
endif()
find_program(HELIOGRAPH_CCACHE ccache)
if(HELIOGRAPH_CCACHE AND PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${HELIOGRAPH_CCACHE})
endif()

# helio_shared_sources(file...): marks sources that include engine/core/shared.hpp. Unsuffixed literals are floats
# there, as in GLSL.
function(helio_shared_sources)
    foreach(source ${ARGN})
        cmake_path(ABSOLUTE_PATH source)
        # A source's properties count in the directory that defines its target: here for tests, the root for
        # the library.
        set_property(SOURCE ${source} DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}
            APPEND PROPERTY COMPILE_OPTIONS -fsingle-precision-constant)
    endforeach()
endfunction()
