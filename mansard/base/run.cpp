#include "mansard/base/run.hpp"

#include "mansard/base/watch.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

namespace mansard::base {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  const auto account = detail::current_account();
  try {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const tbb::blocked_range<std::size_t>& range) {
      const detail::Charge charge(account);
      for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
    });
  } catch (const std::runtime_error& e) {
    // So the library reports that there is no memory for the stack of a thread. Callers would blame their data.
    if (std::string_view(e.what()).starts_with("pthread_create")) throw std::bad_alloc();
    throw;
  }
}

void limit_threads(std::size_t threads) {
  static std::unique_ptr<tbb::global_control> limit;
  limit.reset();
  if (threads > 0) limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

}  // namespace mansard::base
