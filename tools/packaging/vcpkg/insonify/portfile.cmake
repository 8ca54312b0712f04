# An overlay port that builds from the checkout it lies in:
#   vcpkg install insonify --overlay-ports=tools/packaging/vcpkg --editable
# --editable because vcpkg's cache of built packages can't tell that the checkout has changed.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)
set(VCPKG_BUILD_TYPE release) # headers alone

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
                      OPTIONS -DINSONIFY_BUILD_TESTS=OFF -DINSONIFY_BUILD_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/insonify)
# vcpkg's GLM has no pkg-config file; its headers are in the same folder.
vcpkg_replace_string("${CURRENT_PACKAGES_DIR}/share/pkgconfig/insonify.pc" "Requires: glm\n" "")
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/doc")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
