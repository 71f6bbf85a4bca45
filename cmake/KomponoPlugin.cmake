# SPDX-License-Identifier: Apache-2.0
# kompono_plugin(NAME [SOURCES ...]): builds lib/kompono/plugins/NAME/{plugin.toml, libNAME.so} from NAME.cpp
# and the plugin.toml beside it. Works in this tree and, after find_package(kompono), out of it.
function(kompono_plugin name)
  cmake_parse_arguments(PLUGIN "" "" "SOURCES" ${ARGN})
  if(NOT PLUGIN_SOURCES)
    set(PLUGIN_SOURCES ${name}.cpp)
  endif()
  set(folder "${CMAKE_BINARY_DIR}/lib/kompono/plugins/${name}")
  add_library(kompono_plugin_${name} MODULE ${PLUGIN_SOURCES})
  target_link_libraries(kompono_plugin_${name} PRIVATE kompono::sdk)
  # The manifest is the only symbol shown: templates of the standard library (simd functions) have default visibility
  # whatever the compiler is told, and unique symbols among them would keep the library from being unmapped.
  set(shown "${CMAKE_CURRENT_BINARY_DIR}/${name}.map")
  file(CONFIGURE OUTPUT "${shown}" CONTENT "{ global: kompono_plugin; local: *; };\n")
  target_link_options(kompono_plugin_${name} PRIVATE -Wl,-z,defs "LINKER:--version-script=${shown}")
  set_target_properties(kompono_plugin_${name} PROPERTIES LINK_DEPENDS "${shown}")
  set_target_properties(kompono_plugin_${name} PROPERTIES
    OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY "${folder}" INSTALL_RPATH "$ORIGIN/../../.."
    CXX_STANDARD 20 CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  configure_file(plugin.toml "${folder}/plugin.toml" COPYONLY)
  include(GNUInstallDirs)
  install(TARGETS kompono_plugin_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name})
  install(FILES plugin.toml DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name})
endfunction()

# kompono_preset(NAME): a plugin of data only, a plugin.toml that presets another plugin's modules.
function(kompono_preset name)
  set(folder "${CMAKE_BINARY_DIR}/lib/kompono/plugins/${name}")
  configure_file(${name}/plugin.toml "${folder}/plugin.toml" COPYONLY)
  include(GNUInstallDirs)
  install(FILES ${name}/plugin.toml DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name})
endfunction()
