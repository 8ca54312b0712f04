# Installs headers, the CMake package, the pkg-config file and the licence into the GNUInstallDirs folders
# (CMAKE_INSTALL_INCLUDEDIR, CMAKE_INSTALL_DATADIR, ...).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/insonify)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/insonify DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS insonify EXPORT insonifyTargets)
install(EXPORT insonifyTargets NAMESPACE insonify:: DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The package does not depend on the architecture. While the major version is 0, a minor version may break.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/insonifyConfigVersion.cmake COMPATIBILITY SameMinorVersion
                                 ARCH_INDEPENDENT)
cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_INCLUDEDIR BASE_DIRECTORY [[${prefix}]] OUTPUT_VARIABLE INSONIFY_PC_INCLUDEDIR)
configure_file(${CMAKE_CURRENT_LIST_DIR}/insonify.pc.in ${PROJECT_BINARY_DIR}/insonify.pc @ONLY)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/insonifyConfig.cmake ${CMAKE_CURRENT_LIST_DIR}/find_glm.cmake ${CMAKE_CURRENT_LIST_DIR}/compiled.cmake
              ${PROJECT_BINARY_DIR}/insonifyConfigVersion.cmake DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/insonify.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)
