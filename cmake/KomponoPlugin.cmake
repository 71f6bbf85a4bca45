# SPDX-License-Identifier: Apache-2.0
# x86-64 levels for which a Release build makes a second and third library of a plugin, in folders of that name beside
# the first; the host opens the best one that the processor runs.
set(KOMPONO_PLUGIN_LEVELS x86-64-v3 x86-64-v4 CACHE STRING "x86-64 levels of plugin libraries in Release builds")

# kompono_plugin(NAME [SOURCES ...] [PLAIN]): builds lib/kompono/plugins/NAME/{plugin.toml, libNAME.so} from NAME.cpp
# and the plugin.toml beside it. PLAIN: one library for all processors, for plugins that have no batches. Works in this
# tree and, after find_package(kompono), out of it.
function(kompono_plugin name)
  cmake_parse_arguments(PLUGIN "PLAIN" "" "SOURCES" ${ARGN})
  if(NOT PLUGIN_SOURCES)
    set(PLUGIN_SOURCES ${name}.cpp)
  endif()
  set(folder "${CMAKE_BINARY_DIR}/lib/kompono/plugins/${name}")
  kompono_plugin_library(${name} "" "")
  if(NOT PLUGIN_PLAIN AND CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    foreach(level IN LISTS KOMPONO_PLUGIN_LEVELS)
      kompono_plugin_library(${name} "_${level}" "${level}")
      # g++ 12 warns of its own intrinsics. Without errno and traps a square root is one instruction.
      target_compile_options(kompono_plugin_${name}_${level} PRIVATE
        -O3 -march=${level} -fno-math-errno -fno-trapping-math -Wno-uninitialized -Wno-maybe-uninitialized)
      add_dependencies(kompono_plugin_${name} kompono_plugin_${name}_${level})
    endforeach()
  endif()
  configure_file(plugin.toml "${folder}/plugin.toml" COPYONLY)
  include(GNUInstallDirs)
  install(FILES plugin.toml DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name})
endfunction()

# One library of a plugin: the target kompono_plugin_NAME<suffix>, built and installed into the plugin's folder or the
# folder `level` in it.
function(kompono_plugin_library name suffix level)
  set(target kompono_plugin_${name}${suffix})
  add_library(${target} MODULE ${PLUGIN_SOURCES})
  target_link_libraries(${target} PRIVATE kompono::sdk)
  # The manifest is the only symbol shown: templates of the standard library (simd functions) have default visibility
  # whatever the compiler is told, and unique symbols among them would keep the library from being unmapped.
  set(shown "${CMAKE_CURRENT_BINARY_DIR}/${name}.map")
  file(CONFIGURE OUTPUT "${shown}" CONTENT "{ global: kompono_plugin; local: *; };\n")
  target_link_options(${target} PRIVATE -Wl,-z,defs "LINKER:--version-script=${shown}")
  set_target_properties(${target} PROPERTIES LINK_DEPENDS "${shown}")
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY "${folder}/${level}"
    INSTALL_RPATH "$ORIGIN/../../..;$ORIGIN/../../../.."
    CXX_STANDARD 20 CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  include(GNUInstallDirs)
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name}/${level})
endfunction()

# kompono_preset(NAME): a plugin of data only, a plugin.toml that presets another plugin's modules.
function(kompono_preset name)
  set(folder "${CMAKE_BINARY_DIR}/lib/kompono/plugins/${name}")
  configure_file(${name}/plugin.toml "${folder}/plugin.toml" COPYONLY)
  include(GNUInstallDirs)
  install(FILES ${name}/plugin.toml DESTINATION ${CMAKE_INSTALL_LIBDIR}/kompono/plugins/${name})
endfunction()
