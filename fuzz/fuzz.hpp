// What the fuzzers share: the entry that libFuzzer calls, and the way out when a promise is broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

extern "C" auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int;

namespace mansard::fuzz {

/// Says what is wrong, and more, and stops, which is how a fuzzer finds a failure.
template <class More>
void promise(bool kept, const char* what, const More& more) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s: %s\n", what, std::string(more()).c_str());
  std::abort();
}
inline void promise(bool kept, const char* what) {
  promise(kept, what, [] { return ""; });
}

}  // namespace mansard::fuzz
