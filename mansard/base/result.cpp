#include "mansard/base/result.hpp"

#include <cstdio>
#include <cstdlib>

#include "mansard/base/text.hpp"

namespace mansard::base {

auto to_string(const Diagnostic& diagnostic) -> std::string {
  std::string line = diagnostic.severity == Severity::error ? "error[" : "warning[";
  line += diagnostic.code + "]";
  if (!diagnostic.subject.empty()) line += " " + diagnostic.subject;
  return on_one_line(line + ": " + diagnostic.message);
}

void detail::bad_result_access(const std::vector<Diagnostic>* failure) {
  // The one place where a library prints: the program ends here, and the reason must not be lost.
  if (failure == nullptr) {
    std::fputs("mansard: bug: a result was read as the failure that it is not\n", stderr);
  } else {
    std::fputs("mansard: bug: the value of a failed result was read:\n", stderr);
    for (const auto& diagnostic : *failure) std::fprintf(stderr, "  %s\n", to_string(diagnostic).c_str());
  }
  std::abort();
}

}  // namespace mansard::base
