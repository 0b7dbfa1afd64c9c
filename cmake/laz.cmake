# The decoder of LAZ: the WebAssembly of npm's laz-perf, with the hash of its lock file, translated to C by Debian's wasm2c and
# compiled into the module `formats` (docs/decisions/0050-laz-in-a-sandbox.md). Without npm or wasm2c, LAZ is refused by
# the program with the reason.
option(MANSARD_LAZ "Build the decoder of LAZ point clouds into the program (needs npm and wabt)" ON)

set(MANSARD_LAZ_FOUND OFF)
if(MANSARD_LAZ)
  find_program(MANSARD_NPM npm)
  find_program(MANSARD_WASM2C wasm2c)
  if(MANSARD_NPM AND MANSARD_WASM2C)
    set(MANSARD_LAZ_FOUND ON)
    enable_language(C)
  else()
    message(WARNING "npm and wasm2c (Debian's package wabt) are needed to read LAZ; without them, mansard reads LAS but refuses LAZ")
  endif()
endif()

function(mansard_laz_decoder target)
  if(NOT MANSARD_LAZ_FOUND)
    return()
  endif()
  set(source ${PROJECT_SOURCE_DIR}/cmake/laz)
  set(folder ${PROJECT_BINARY_DIR}/laz)
  set(made ${folder}/mansard/formats/las)  # included from the root, as all headers are
  set(c ${made}/laz_perf.c)
  set(header ${made}/laz_perf.h)
  add_custom_command(OUTPUT ${c} ${header}
    COMMAND ${CMAKE_COMMAND} -DNPM=${MANSARD_NPM} -DWASM2C=${MANSARD_WASM2C} -DSOURCE=${source} -DFOLDER=${folder} -DMADE=${made}
            -P ${source}/translate.cmake
    DEPENDS ${source}/package.json ${source}/package-lock.json ${source}/translate.cmake
    COMMENT "Translating the decoder of LAZ" VERBATIM)
  set(runtime ${PROJECT_SOURCE_DIR}/mansard/formats/las/laz_runtime.h)
  target_sources(${target} PRIVATE ${c} ${header})
  # Generated code: no warnings. -O1 is as fast as -O3 here and compiles in half the time. Faults are C++ exceptions that
  # pass through it.
  set_source_files_properties(${c} PROPERTIES SKIP_PRECOMPILE_HEADERS ON
    COMPILE_OPTIONS "-w;-O1;-fexceptions;-include;${runtime}" OBJECT_DEPENDS "${runtime}")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/mansard/formats/las/laz_sandbox.cpp PROPERTIES
    COMPILE_DEFINITIONS MANSARD_HAS_LAZ INCLUDE_DIRECTORIES ${folder} OBJECT_DEPENDS ${header})
endfunction()
