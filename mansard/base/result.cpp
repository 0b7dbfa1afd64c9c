#include "mansard/base/result.hpp"

namespace mansard::base {

auto to_string(const Diagnostic& diagnostic) -> std::string {
  std::string line = diagnostic.severity == Severity::error ? "error[" : "warning[";
  line += diagnostic.code + "]";
  if (!diagnostic.subject.empty()) line += " " + diagnostic.subject;
  return line + ": " + diagnostic.message;
}

}  // namespace mansard::base
