#include "mansard/base/watch.hpp"

#include <gtest/gtest.h>
#include <array>
#include <ctime>
#include <stdexcept>

#include "mansard/base/run.hpp"

namespace mansard::base {
namespace {

auto cpu_seconds(clockid_t clock) -> double {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Works until the thread has used that much processor time.
void work(double seconds) {
  const double end = cpu_seconds(CLOCK_THREAD_CPUTIME_ID) + seconds;
  while (cpu_seconds(CLOCK_THREAD_CPUTIME_ID) < end) {
  }
}

constexpr double rounding = 1e-6;  // s; far above what sums of nanoseconds lose in doubles

TEST(Watch, counts_the_work_of_its_thread) {
  Watch watch;
  work(0.01);
  const auto spent = watch.stop();
  EXPECT_GE(spent.cpu_seconds, 0.01 - rounding);
  EXPECT_GE(spent.wall_seconds, 0.01 - rounding);
}

TEST(Watch, counts_work_in_nested_loops_on_any_thread_and_no_more_than_the_process_used) {
  for (const std::size_t threads : {1, 4}) {
    limit_threads(threads);
    const double before = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
    Watch watch;
    parallel_for(4, [](std::size_t) { parallel_for(5, [](std::size_t) { work(0.002); }); });
    const auto spent = watch.stop();
    EXPECT_GE(spent.cpu_seconds, 4 * 5 * 0.002 - rounding) << threads;
    EXPECT_LE(spent.cpu_seconds, cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - before + rounding) << threads;
  }
  limit_threads(0);
}

TEST(Watch, counts_nothing_of_pieces_of_work_that_run_at_the_same_time) {
  limit_threads(4);
  std::array<Spent, 8> spent;
  const double before = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
  Watch all;
  parallel_for(spent.size(), [&](std::size_t i) {
    Watch own;
    parallel_for(4, [&](std::size_t) { work(i == 0 ? 0.02 : 0.001); });
    spent.at(i) = own.stop();
  });
  const auto total = all.stop();
  double sum = 0;
  for (const auto& one : spent) sum += one.cpu_seconds;
  EXPECT_GE(spent[0].cpu_seconds, 4 * 0.02 - rounding);
  EXPECT_LE(sum, total.cpu_seconds + rounding);
  EXPECT_LE(total.cpu_seconds, cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - before + rounding);
  limit_threads(0);
}

TEST(Watch, adds_the_work_of_an_inner_watch_to_the_outer_one) {
  Watch outer;
  {
    Watch inner;
    work(0.005);
    EXPECT_GE(inner.stop().cpu_seconds, 0.005 - rounding);
  }
  {
    const Watch never_stopped;
    work(0.005);
  }
  EXPECT_GE(outer.stop().cpu_seconds, 0.01 - rounding);
}

TEST(Watch, goes_on_after_an_exception_in_a_loop) {
  Watch watch;
  EXPECT_THROW(parallel_for(4, [](std::size_t) { throw std::runtime_error("one"); }), std::runtime_error);
  work(0.005);
  EXPECT_GE(watch.stop().cpu_seconds, 0.005 - rounding);
}

TEST(Spent, combined_adds_processor_time_and_joins_overlapping_times) {
  const auto at = [](int seconds) { return std::chrono::steady_clock::time_point(std::chrono::seconds(seconds)); };
  const std::array<Spent, 4> pieces{Spent{1, 2, at(20)}, Spent{2, 4, at(10)}, Spent{3, 1, at(11)}, Spent{4, 3, at(12)}};
  const auto sum = combined(pieces);
  EXPECT_EQ(sum.cpu_seconds, 10);
  EXPECT_EQ(sum.wall_seconds, 7) << "10 to 15 and 20 to 22";
  EXPECT_EQ(sum.begin, at(10));
  EXPECT_EQ(combined({}).wall_seconds, 0);
}

}  // namespace
}  // namespace mansard::base
