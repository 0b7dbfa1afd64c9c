#include "mansard/base/result.hpp"

namespace mansard::base {
namespace {

/// Names come from files: a line break in one must not make two lines of one, nor an escape code reach a terminal.
auto on_one_line(std::string text) -> std::string {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

auto to_string(const Diagnostic& diagnostic) -> std::string {
  std::string line = diagnostic.severity == Severity::error ? "error[" : "warning[";
  line += diagnostic.code + "]";
  if (!diagnostic.subject.empty()) line += " " + diagnostic.subject;
  return on_one_line(line + ": " + diagnostic.message);
}

}  // namespace mansard::base
