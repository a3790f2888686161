# helio_add_kernels(TARGET file.comp...)
#
# Compiles compute kernels to SPIR-V at build and embeds them in TARGET. A file PASS/NAME.comp, given relative to
# the current source folder or to the include root, becomes
#
#     #include <heliograph_kernels/PASS.hpp>      // namespace helio::shaders { extern const Kernel NAME; }
#
# NAME must be a C++ identifier that no other kernel of the project or of the installed library has. All kernels
# of one folder are given in one call. Includes are written from the include root: `#include "shaders/x.glsl"`. The
# root is Heliograph's own source tree for kernels inside it; for an application it is the folder of the calling
# CMakeLists.txt, and then the shader library. A kernel is compiled again when a file it includes changes, and
# only then. A kernel that includes "generated.glsl" finds it empty at build (see KernelVariant).
#
# The same file serves the project and, installed next to heliographConfig.cmake, applications; the latter find
# the GLSL library under HELIOGRAPH_SHADER_ROOT, which the package configuration may set.

find_program(HELIOGRAPH_GLSLANG glslangValidator)
if(NOT HELIOGRAPH_GLSLANG)
    message(FATAL_ERROR "Heliograph needs glslangValidator to compile kernels; install the package glslang-tools")
endif()

set(_helio_kernels_dir ${CMAKE_CURRENT_LIST_DIR})
if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/../engine/shader/CMakeLists.txt)
    get_filename_component(HELIOGRAPH_SHADER_ROOT ${CMAKE_CURRENT_LIST_DIR}/.. REALPATH)
    set(_helio_in_tree TRUE)
elseif(NOT HELIOGRAPH_SHADER_ROOT)
    set(HELIOGRAPH_SHADER_ROOT ${CMAKE_CURRENT_LIST_DIR}/shader_library)
endif()
if(NOT _helio_in_tree)
    # An application's kernel of the same name would take the place of the library's.
    file(GLOB_RECURSE _helio_taken RELATIVE ${HELIOGRAPH_SHADER_ROOT} ${HELIOGRAPH_SHADER_ROOT}/passes/*.comp)
    foreach(_helio_source IN LISTS _helio_taken)
        get_filename_component(_helio_name ${_helio_source} NAME_WE)
        set_property(GLOBAL PROPERTY helio_kernel_${_helio_name} "Heliograph's own ${_helio_source}")
    endforeach()
endif()

# helio_shader_sources(OUT): every file that kernels of the library may include or be, relative to the root.
function(helio_shader_sources out)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${HELIOGRAPH_SHADER_ROOT}
        ${HELIOGRAPH_SHADER_ROOT}/shaders/*.glsl ${HELIOGRAPH_SHADER_ROOT}/shaders/*.h
        ${HELIOGRAPH_SHADER_ROOT}/passes/*.glsl ${HELIOGRAPH_SHADER_ROOT}/passes/*.comp)
    list(SORT files)
    set(${out} ${files} PARENT_SCOPE)
endfunction()

function(helio_add_kernels target)
    if(NOT TARGET ${target})
        message(FATAL_ERROR "helio_add_kernels: '${target}' is not a target")
    endif()
    if(NOT ARGN)
        message(FATAL_ERROR "helio_add_kernels(${target}): give at least one .comp file")
    endif()
    get_filename_component(here ${CMAKE_CURRENT_SOURCE_DIR} REALPATH)
    cmake_path(IS_PREFIX HELIOGRAPH_SHADER_ROOT ${here} NORMALIZE inside)
    if(inside)
        set(root ${HELIOGRAPH_SHADER_ROOT})
    else()
        set(root ${here})
    endif()
    set(build ${CMAKE_CURRENT_BINARY_DIR}/heliograph_kernels/${target})
    set(include ${build}/include)

    set(passes)
    foreach(file IN LISTS ARGN)
        get_filename_component(path ${file} ABSOLUTE BASE_DIR ${here})
        if(NOT EXISTS ${path})
            get_filename_component(path ${file} ABSOLUTE BASE_DIR ${root})
        endif()
        if(NOT EXISTS ${path})
            message(FATAL_ERROR "helio_add_kernels(${target}): ${file} is neither in ${here} nor in ${root}")
        endif()
        get_filename_component(path ${path} REALPATH)
        cmake_path(IS_PREFIX root ${path} NORMALIZE under)
        if(NOT under)
            message(FATAL_ERROR "helio_add_kernels(${target}): ${path} is outside of the include root ${root}")
        endif()
        file(RELATIVE_PATH source ${root} ${path})
        get_filename_component(name ${path} NAME_WE)
        get_filename_component(folder ${path} DIRECTORY)
        get_filename_component(pass ${folder} NAME)
        if(NOT path MATCHES "\\.comp$" OR NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
            message(FATAL_ERROR "helio_add_kernels(${target}): ${source}: a kernel's file is named NAME.comp, "
                "NAME a C++ identifier")
        endif()
        get_property(owner GLOBAL PROPERTY helio_kernel_${name})
        if(owner)
            message(FATAL_ERROR "helio_add_kernels(${target}): two kernels are called '${name}': ${owner} and "
                "${source}; rename one file")
        endif()
        set_property(GLOBAL PROPERTY helio_kernel_${name} ${source})

        set(spirv ${build}/${pass}/${name}.spv)
        set_property(TARGET ${target} APPEND PROPERTY helio_spirv_files ${spirv})
        file(MAKE_DIRECTORY ${build}/${pass})
        add_custom_command(OUTPUT ${spirv}
            COMMAND ${HELIOGRAPH_GLSLANG} -V --target-env vulkan1.3 --quiet -I${root} -I${HELIOGRAPH_SHADER_ROOT}
                -I${_helio_kernels_dir}/kernels --depfile ${spirv}.d -o ${spirv} ${path}
            DEPENDS ${path}
            DEPFILE ${spirv}.d
            COMMENT "Compiling kernel ${source}"
            VERBATIM)
        list(APPEND passes ${pass})
        list(APPEND ${pass}_names ${name})
        list(APPEND ${pass}_spirv ${spirv})
        list(APPEND ${pass}_table "${name}|${source}|${spirv}")
    endforeach()

    list(REMOVE_DUPLICATES passes)
    foreach(pass IN LISTS passes)
        get_property(taken TARGET ${target} PROPERTY helio_pass_${pass})
        if(taken)
            message(FATAL_ERROR "helio_add_kernels(${target}): kernels of a folder '${pass}' were added before; "
                "give all of a folder's kernels in one call")
        endif()
        set_property(TARGET ${target} PROPERTY helio_pass_${pass} TRUE)

        set(declarations)
        foreach(name IN LISTS ${pass}_names)
            string(APPEND declarations "extern const Kernel ${name};\n")
        endforeach()
        file(CONFIGURE OUTPUT ${include}/heliograph_kernels/${pass}.hpp @ONLY CONTENT
            "#pragma once\n#include <heliograph/kernel.hpp>\n\nnamespace helio::shaders {\n@declarations@}\n")

        set(table ${build}/${pass}.cpp)
        # The library embeds its whole source tree; any other target brings along what its kernels are made of.
        set(embed_sources TRUE)
        if(target STREQUAL "heliograph" AND _helio_in_tree)
            set(embed_sources FALSE)
        endif()
        add_custom_command(OUTPUT ${table}
            COMMAND ${CMAKE_COMMAND} "-DOUT=${table}" "-DPASS=${pass}" "-DKERNELS=${${pass}_table}" "-DROOT=${root}"
                "-DSHADER_ROOT=${HELIOGRAPH_SHADER_ROOT}" "-DSOURCES=${embed_sources}"
                -P ${_helio_kernels_dir}/kernels/EmbedKernels.cmake
            DEPENDS ${${pass}_spirv} ${_helio_kernels_dir}/kernels/EmbedKernels.cmake
            COMMENT "Embedding kernels of ${pass}"
            VERBATIM)
        # Custom commands belong to the folder they are written in, the target perhaps to another one: an object
        # library of this folder carries the objects over.
        set(objects ${target}_kernels_${pass})
        add_library(${objects} OBJECT ${table})
        set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_STANDARD 20)
        if(TARGET heliograph)
            target_include_directories(${objects} PRIVATE $<TARGET_PROPERTY:heliograph,INTERFACE_INCLUDE_DIRECTORIES>)
        else()
            target_link_libraries(${objects} PRIVATE heliograph::heliograph)
        endif()
        target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
    endforeach()

    if(target STREQUAL "heliograph" AND _helio_in_tree)
        target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${include}>)
    else()
        target_include_directories(${target} PRIVATE ${include})
    endif()
endfunction()
