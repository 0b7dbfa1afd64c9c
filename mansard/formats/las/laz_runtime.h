/* Included before the C that wasm2c writes (cmake/laz.cmake): bounds are checked in the code, not by signals, and the
   depth of calls is counted per thread. wasm-rt.h declares one counter for all threads, so the name is replaced behind
   it. */
#ifndef MANSARD_LAZ_RUNTIME_H
#define MANSARD_LAZ_RUNTIME_H

#define WASM_RT_MEMCHECK_SIGNAL_HANDLER 0
#define WASM_RT_USE_STACK_DEPTH_COUNT 1
#include <wasm-rt.h>

#ifdef __cplusplus
extern "C" thread_local uint32_t mansard_laz_depth;
#else
extern _Thread_local uint32_t mansard_laz_depth;
#endif
#define wasm_rt_call_stack_depth mansard_laz_depth

#endif
