# SPDX-License-Identifier: Apache-2.0
# cmake -P: install, extract, configure, build, run, compare.
cmake_minimum_required(VERSION 3.25)
set(prefix "${WORK}/prefix")
set(crank "${WORK}/crank")
set(out "${WORK}/build")
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${crank}")

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}\n${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run("installation" "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")

run("extraction" "${AWK}" -v "folder=${crank}" -f "${HERE}/extract_blocks.awk" "${SOURCE}/docs/writing-a-plugin.md")
foreach(file IN ITEMS plugin.toml crank.cpp CMakeLists.txt turn.cpp output.txt)
  if(NOT EXISTS "${crank}/${file}")
    message(FATAL_ERROR "docs/writing-a-plugin.md has no block for ${file}")
  endif()
endforeach()
file(STRINGS "${crank}/crank.cpp" lines)
list(LENGTH lines count)
if(count GREATER_EQUAL 100)
  message(FATAL_ERROR "the plugin of the guide has ${count} lines; a simple mechanism must stay below 100")
endif()

run("configuring the plugin" "${CMAKE_COMMAND}" -S "${crank}" -B "${out}" -G "${GENERATOR}"
    "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_C_COMPILER=${C}"
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" "-DCMAKE_BUILD_TYPE=${TYPE}" "-DCMAKE_CXX_FLAGS=${FLAGS}"
    "-DCMAKE_CXX_FLAGS_DEV=${DEV_FLAGS}")
run("building the plugin" "${CMAKE_COMMAND}" --build "${out}" -j2)

set(ENV{KOMPONO_PLUGIN_PATH} "${out}/lib/kompono/plugins")
run("the program of the guide" "${out}/turn")
file(READ "${crank}/output.txt" expected)
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "the guide says it prints\n${expected}\nit prints\n${output}")
endif()

# Installed where kompono looks, the plugin is found without the variable, by a program in another folder.
run("installing the plugin" "${CMAKE_COMMAND}" --install "${out}" --prefix "${prefix}")
unset(ENV{KOMPONO_PLUGIN_PATH})
file(COPY "${out}/turn" DESTINATION "${prefix}/bin")
run("the program beside the installed plugin" "${prefix}/bin/turn")
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "installed it prints\n${output}")
endif()

# The manifest is the only thing a plugin shows. (Sanitizers add marks of their own to it.)
file(GLOB libraries "${prefix}/${LIBDIR}/kompono/plugins/*/*.so")
list(LENGTH libraries count)
if(count LESS 2)
  message(FATAL_ERROR "only ${count} plugin libraries were installed")
endif()
foreach(library IN LISTS libraries)
  run("nm" "${NM}" -D --defined-only --format=posix "${library}")
  string(REGEX REPLACE "__(odr_)?asan[^\n]*\n" "" shown "${output}")
  string(REGEX REPLACE " [^\n]*\n" ";" shown "${shown}")
  if(NOT shown STREQUAL "kompono_plugin;")
    message(FATAL_ERROR "${library} shows more than its manifest: ${shown}")
  endif()
endforeach()
message(STATUS "${count} plugin libraries show their manifest and nothing else")
