#include "apps/python/work.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace py = pybind11;

namespace mansard::python {

void raise_error(const std::vector<base::Diagnostic>& diagnostics) {
  if (diagnostics.front().code == "cancelled") {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  py::list all;
  for (const auto& diagnostic : diagnostics) all.append(py::cast(diagnostic));
  const auto type = py::module_::import("mansard._errors").attr("Error");
  PyErr_SetObject(type.ptr(), type(all).ptr());
  throw py::error_already_set();
}

namespace {

/// The latest progress, from the thread that works to the one that tells.
struct Shared {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false, news = false;
  std::string stage, subject;
  double fraction = 0;
};

}  // namespace

void run_work(const py::object& progress, std::uint64_t seed, const std::function<void(const base::Run&)>& work) {
  // How often signals are looked for: within this Ctrl-C is noticed. Python itself looks every 5 ms when threads
  // compete.
  constexpr std::chrono::milliseconds pause{50};
  Shared shared;
  base::Cancel cancel;
  base::Run run;
  run.cancel = &cancel;
  run.seed = seed;
  if (!progress.is_none())
    run.progress = [&shared](auto stage, auto subject, double fraction) {
      const std::lock_guard lock(shared.mutex);
      shared.news = true;
      shared.stage = stage;
      shared.subject = subject;
      shared.fraction = fraction;
    };
  std::exception_ptr failure, asked_to_stop;
  std::thread worker([&] {
    try {
      work(run);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(shared.mutex);
    shared.done = true;
    shared.changed.notify_one();
  });
  for (bool done = false; !done;) {
    bool news = false;
    std::string stage, subject;
    double fraction = 0;
    {
      const py::gil_scoped_release release;
      std::unique_lock lock(shared.mutex);
      done = shared.changed.wait_for(lock, pause, [&] { return shared.done; });
      news = std::exchange(shared.news, false);
      if (news) stage = shared.stage, subject = shared.subject, fraction = shared.fraction;
    }
    if (asked_to_stop) continue;
    try {
      if (news) progress(stage, subject, fraction);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (...) {
      asked_to_stop = std::current_exception();
      cancel.request();
    }
  }
  worker.join();
  if (asked_to_stop) std::rethrow_exception(asked_to_stop);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace mansard::python
