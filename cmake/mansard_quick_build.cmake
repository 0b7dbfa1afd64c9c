# A quicker build from nothing, for the presets `release`, `debug` and `clang`: `make demo`, `make test` and continuous
# integration. Modules and programs are optimised as without it. What is different:
#   Headers of the standard library, GoogleTest in tests and CLI11 in the command line are parsed once, not once a source.
#   Our own are not among them: to change one compiles those that include it, no more. Nor is nlohmann/json: g++
#   instantiates again in every source what such a header leaves open, which costs as much as parsing it.
#   Tests of a release are compiled with -O1. They spend their time in the modules.
# A source that forgets an #include of these still compiles, and g++ 12 warns of strings that it does not understand. So
# a build without, of the same sources with all warnings, is what the preset asan is, and any folder configured by hand.
# tools/tidy.sh parses every source of the modules alone, with clang.
option(MANSARD_QUICK_BUILD "Precompiled headers, and tests less optimised (g++, clang): a quick build from nothing" OFF)
if(NOT PROJECT_IS_TOP_LEVEL OR NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$")
  set(MANSARD_QUICK_BUILD OFF)
endif()

# MANSARD_UNITY, which the Makefile sets for a new folder and the presets debug and clang for theirs, compiles the sources of
# a folder together, so that headers are parsed and templates are compiled once a folder. Who changes sources is quicker
# without: one source is compiled then, not all of its folder. Names in anonymous namespaces have to be unique in a folder;
# `make demo` and `make test` see to that.
option(MANSARD_UNITY "Compile the sources of a folder as one unit, with MANSARD_QUICK_BUILD: quicker from nothing" OFF)

if(MANSARD_QUICK_BUILD)
  # Warnings of what is left after inlining, which differs: -Wstringop-overflow at "text" + std::string is a false alarm
  # akin to -Wrestrict in CMakeLists.txt; the others are its relatives.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds -Wno-maybe-uninitialized)
  endif()
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    # ccache accepts precompiled headers on these terms. Paths below the source folder are relative to it, so that
    # checkouts share what they compiled.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      add_compile_options(-fpch-preprocess)
    else()
      add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
    endif()
    list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR})
  endif()
endif()

# mansard_united(target): the sources of each folder of `target` are compiled as one unit; a folder with more than 80 kB of
# sources as several, so that no unit takes long alone or much memory. Call it when the target has its sources.
function(mansard_united target)
  if(NOT MANSARD_QUICK_BUILD OR NOT MANSARD_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Both warn of what is right in sources of their own, where a build without units has them: names that a source before has
  # too, and members of types in anonymous namespaces.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  get_target_property(root ${target} SOURCE_DIR)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  set(folders "")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${root} OUTPUT_VARIABLE path)
    if(NOT EXISTS ${path})  # made by the build
      continue()
    endif()
    cmake_path(GET path PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    if(NOT folder IN_LIST folders)
      list(APPEND folders ${folder})
      set(sources_${folder} "")
      set(bytes_${folder} 0)
    endif()
    list(APPEND sources_${folder} ${source})
    file(SIZE ${path} bytes)
    math(EXPR bytes_${folder} "${bytes_${folder}} + ${bytes}")
  endforeach()
  foreach(folder IN LISTS folders)
    list(LENGTH sources_${folder} count)
    math(EXPR units "(${bytes_${folder}} + 79999) / 80000")
    set(number 0)
    foreach(source IN LISTS sources_${folder})
      math(EXPR unit "${number} * ${units} / ${count}")
      math(EXPR number "${number} + 1")
      string(MD5 group "${folder} ${unit}")  # names of files: short ones
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
    endforeach()
  endforeach()
endfunction()

# mansard_precompiled(target modules|tests|commands): `target` uses the precompiled headers of modules, those of tests, or those
# of the command line, which is compiled as its own target is.
function(mansard_precompiled target what)
  if(NOT MANSARD_QUICK_BUILD)
    return()
  endif()
  set(owner mansard_precompiled_${what})
  if(NOT TARGET ${owner})  # a library of one empty source, since CMake wants one
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${what}.cpp CONTENT "" @ONLY)
    add_library(${owner} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/${what}.cpp)
    target_precompile_headers(${owner} PRIVATE <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional>
      <limits> <map> <memory> <mutex> <numeric> <optional> <random> <set> <span> <sstream> <string> <tuple> <utility>
      <variant> <vector>)
    if(what STREQUAL "modules")
      set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    if(what STREQUAL "tests")
      target_precompile_headers(${owner} PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
      target_link_libraries(${owner} PRIVATE GTest::gmock GTest::gtest)
    elseif(what STREQUAL "commands")
      target_precompile_headers(${owner} PRIVATE <CLI/CLI.hpp>)
      target_link_libraries(${owner} PRIVATE CLI11::CLI11)
      get_target_property(options ${target} COMPILE_OPTIONS)
      target_compile_options(${owner} PRIVATE ${options})
    endif()
  endif()
  if(what STREQUAL "modules")  # a program is compiled otherwise than a library: -fPIE
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "EXECUTABLE")
      return()
    endif()
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
