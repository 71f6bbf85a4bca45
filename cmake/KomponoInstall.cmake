# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)
set(kompono_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kompono)
install(EXPORT komponoTargets NAMESPACE kompono:: DESTINATION ${kompono_cmake_dir})
configure_package_config_file(cmake/komponoConfig.cmake.in "${PROJECT_BINARY_DIR}/komponoConfig.cmake"
                              INSTALL_DESTINATION ${kompono_cmake_dir})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/komponoConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/komponoConfig.cmake" "${PROJECT_BINARY_DIR}/komponoConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/KomponoPlugin.cmake"
        DESTINATION ${kompono_cmake_dir})
