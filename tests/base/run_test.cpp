#include "mansard/base/run.hpp"

#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace mansard::base {
namespace {

TEST(ParallelFor, does_every_piece_once_at_any_thread_count) {
  for (const std::size_t threads : {1, 2, 0}) {
    limit_threads(threads);
    std::vector<int> done(1000, 0);
    parallel_for(done.size(), [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 1000);
  }
  limit_threads(0);
}

TEST(ParallelFor, passes_an_exception_on) {
  EXPECT_THROW(parallel_for(10,
                            [](std::size_t i) {
                              if (i == 7) throw std::runtime_error("seven");
                            }),
               std::runtime_error);
}

TEST(Random, is_the_same_everywhere_and_differs_by_stream) {
  Random a(1), b(1), c(1, 1), d(2);
  EXPECT_EQ(a.next(), b.next());
  EXPECT_NE(Random(1).next(), c.next());
  EXPECT_NE(Random(1).next(), d.next());
  Random known(0);
  EXPECT_EQ(known.next(), 0x6e789e6aa1b965f4ULL);  // the second number of SplitMix64 from 0
  for (int i = 0; i < 1000; ++i) {
    const double u = a.uniform(2, 3);
    EXPECT_GE(u, 2);
    EXPECT_LT(u, 3);
  }
}

TEST(Cancel, is_seen_through_a_run) {
  Cancel cancel;
  base::Run run;
  EXPECT_FALSE(run.cancelled());
  run.cancel = &cancel;
  EXPECT_FALSE(run.cancelled());
  cancel.request();
  EXPECT_TRUE(run.cancelled());
}

}  // namespace
}  // namespace mansard::base
