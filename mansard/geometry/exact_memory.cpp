#include "mansard/geometry/exact_memory.hpp"

#include <gmp.h>
#include <cstdlib>
#include <new>

namespace mansard::geometry {
namespace {

/// Nothing may be thrown through GMP, which is C.
[[noreturn]] void fail() noexcept {
  if (const auto handler = std::get_new_handler()) handler();
  std::abort();
}

auto allocate(std::size_t bytes) -> void* {
  if (void* const place = std::malloc(bytes)) return place;
  fail();
}

auto reallocate(void* old, std::size_t, std::size_t bytes) -> void* {
  if (void* const place = std::realloc(old, bytes)) return place;
  fail();
}

void release(void* place, std::size_t) { std::free(place); }

}  // namespace

void exact_numbers_end_by_new_handler() { mp_set_memory_functions(allocate, reallocate, release); }

}  // namespace mansard::geometry
