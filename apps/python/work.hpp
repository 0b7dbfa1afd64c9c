// Work of the engine on behalf of Python: without the interpreter's lock, with progress, stoppable by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>
#include <functional>
#include <optional>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::python {

/// Raises mansard.Error with all diagnostics of a failure, or KeyboardInterrupt where it is "cancelled".
[[noreturn]] void raise_error(const std::vector<base::Diagnostic>& diagnostics);

/// The value, or the exception.
template <class T>
auto value_of(base::Result<T> result) -> T {
  if (!result) raise_error(result.errors());
  if constexpr (!std::is_void_v<T>) return *std::move(result);
}

/// Runs `work` on a thread of its own, without the lock. Meanwhile the caller's thread passes progress on to
/// `progress(stage, subject, fraction)`, unless that is None, and looks for signals: on Ctrl-C, or an exception of
/// `progress`, the work gets the request to stop, and the exception goes on once it has.
void run_work(const pybind11::object& progress, std::uint64_t seed, const std::function<void(const base::Run&)>& work);

/// The result of such work.
template <class F>
auto run_for(const pybind11::object& progress, std::uint64_t seed, F&& work) {
  std::optional<std::invoke_result_t<F, const base::Run&>> result;
  run_work(progress, seed, [&](const base::Run& run) { result.emplace(work(run)); });
  return value_of(*std::move(result));
}

}  // namespace mansard::python
