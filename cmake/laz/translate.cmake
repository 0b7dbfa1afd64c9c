# cmake -DNPM=… -DWASM2C=… -DSOURCE=… -DFOLDER=… -DMADE=… -P translate.cmake: MADE gets laz_perf.c and .h
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE failed OUTPUT_VARIABLE said
    ERROR_VARIABLE said)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command} failed:\n${said}\n"
      "Without the decoder of LAZ: cmake -DMANSARD_LAZ=OFF. Behind a proxy or without a network, see docs/serve.md.")
  endif()
endfunction()

file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${FOLDER})
run(${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline)
set(wasm ${FOLDER}/node_modules/laz-perf/lib/laz-perf.wasm)
file(SHA256 ${wasm} hash)
if(NOT hash STREQUAL "9c1802bc31b567dd4aa1ce9ab010e7e51e095dc42af8379b474ae6f221a9327f")
  message(FATAL_ERROR "${wasm} is not the one that mansard/formats/las/laz_sandbox.cpp was written for: SHA-256 ${hash}")
endif()
execute_process(COMMAND ${WASM2C} --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT version STREQUAL "1.0.32")
  message(FATAL_ERROR "wasm2c 1.0.32 is needed, whose output mansard/formats/las/laz_sandbox.cpp was written for; this "
    "is ${version}. Without the decoder of LAZ: cmake -DMANSARD_LAZ=OFF")
endif()
file(MAKE_DIRECTORY ${MADE})
run(${WASM2C} --module-name=lazperf ${wasm} -o ${MADE}/laz_perf.c)
