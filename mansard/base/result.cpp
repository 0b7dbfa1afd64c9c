#include "mansard/base/result.hpp"

#include "mansard/base/text.hpp"

namespace mansard::base {

auto to_string(const Diagnostic& diagnostic) -> std::string {
  std::string line = diagnostic.severity == Severity::error ? "error[" : "warning[";
  line += diagnostic.code + "]";
  if (!diagnostic.subject.empty()) line += " " + diagnostic.subject;
  return on_one_line(line + ": " + diagnostic.message);
}

}  // namespace mansard::base
