# A quicker build from nothing, for the preset `release`: `make demo`, `make test` and continuous integration. Modules and
# programs are optimised as without it. What is different:
#   Headers of the standard library, GoogleTest in tests and CLI11 in the command line are parsed once, not once a source.
#   Our own are not among them: to change one compiles those that include it, no more. Nor is nlohmann/json: g++
#   instantiates again in every source what such a header leaves open, which costs as much as parsing it.
#   Tests are compiled with -O1. They spend their time in the modules.
# A source that forgets an #include of these still compiles, and g++ 12 warns of strings that it does not understand. So
# a build without, of the same sources with all warnings, is what the presets debug and asan are, and any folder
# configured by hand.
option(MANSARD_QUICK_BUILD "Precompiled headers, and tests less optimised (g++): a quick build from nothing" OFF)
if(NOT PROJECT_IS_TOP_LEVEL OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(MANSARD_QUICK_BUILD OFF)
endif()

if(MANSARD_QUICK_BUILD)
  # Warnings of what is left after inlining, which differs: -Wstringop-overflow at "text" + std::string is a false alarm
  # akin to -Wrestrict in CMakeLists.txt; the others are its relatives.
  add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds -Wno-maybe-uninitialized)
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    # ccache accepts precompiled headers on these terms. Paths below the source folder are relative to it, so that
    # checkouts share what they compiled.
    add_compile_options(-fpch-preprocess)
    list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR})
  endif()
endif()

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
