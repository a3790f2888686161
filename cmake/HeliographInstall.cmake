# cmake --install: the library, its public headers, and a package for find_package(heliograph).
include(CMakePackageConfigHelpers)

set(heliograph_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/heliograph)

install(TARGETS heliograph EXPORT heliograph_targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS heliograph_image LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT heliograph_targets FILE heliographTargets.cmake NAMESPACE heliograph:: DESTINATION ${heliograph_package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/heliographConfig.cmake.in
    ${PROJECT_BINARY_DIR}/heliographConfig.cmake INSTALL_DESTINATION ${heliograph_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/heliographConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/heliographConfig.cmake ${PROJECT_BINARY_DIR}/heliographConfigVersion.cmake
    DESTINATION ${heliograph_package_dir})
# helio_add_kernels and what it needs of the source tree, for applications' own kernels.
install(FILES ${PROJECT_SOURCE_DIR}/cmake/HeliographKernels.cmake DESTINATION ${heliograph_package_dir} COMPONENT kernels)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cmake/kernels DESTINATION ${heliograph_package_dir} COMPONENT kernels)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders ${PROJECT_SOURCE_DIR}/passes
    DESTINATION ${heliograph_package_dir}/shader_library COMPONENT kernels
    FILES_MATCHING PATTERN "*.glsl" PATTERN "*.comp" PATTERN "*.h")
