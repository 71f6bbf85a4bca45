# SPDX-License-Identifier: Apache-2.0
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
# Installed programs find the contract's library whatever the prefix is.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

# kompono_part(NAME [SHARED] [SOURCES ...] [USES ...] [LINKS ...])
# One library target kompono::NAME, headers below include/kompono/NAME, USES = other parts (the arrows of the
# architecture), LINKS = outside libraries. A part without sources is a header library.
function(kompono_part name)
  cmake_parse_arguments(PART "SHARED" "" "SOURCES;USES;LINKS" ${ARGN})
  if(PART_SOURCES)
    set(kind STATIC)
    if(PART_SHARED)
      set(kind SHARED)
    endif()
    set(scope PUBLIC)
    add_library(kompono_${name} ${kind} ${PART_SOURCES})
  else()
    set(scope INTERFACE)
    add_library(kompono_${name} INTERFACE)
  endif()
  add_library(kompono::${name} ALIAS kompono_${name})
  set_target_properties(kompono_${name} PROPERTIES EXPORT_NAME ${name})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/include/kompono/*.hpp"
       "${CMAKE_CURRENT_SOURCE_DIR}/include/kompono/*.h")
  target_sources(kompono_${name} ${scope} FILE_SET HEADERS BASE_DIRS include FILES ${headers})
  foreach(other IN LISTS PART_USES)
    target_link_libraries(kompono_${name} ${scope} kompono::${other})
  endforeach()
  target_link_libraries(kompono_${name} ${scope} ${PART_LINKS})
  target_compile_features(kompono_${name} ${scope} cxx_std_20)
  install(TARGETS kompono_${name} EXPORT komponoTargets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()
