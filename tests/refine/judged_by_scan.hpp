// A roof that is judged by the scan of another.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/law.hpp"
#include "scans.hpp"

namespace scans {

class JudgedByScan : public testing::Test {
 protected:
  /// The first roof, by a scan of the other with that noise, measured as it is given.
  auto judged(const Plan& roof, const std::vector<Plan>& truth, double noise, const model::Accuracy& accuracy)
      -> refine::detail::Judged {
    mesh_.emplace(scan(truth, noise));
    options_ = refine::decided_by({}, accuracy);
    site_ = refine::detail::look(model::polygon_of(roof), ground, *mesh_, options_);
    judge_.emplace(site_, options_, raising_, run_);
    return *(*judge_)(roof);
  }
  refine::Options options_;
  extrude::Options raising_;
  base::Run run_;
  std::optional<rays::Scene> mesh_;
  refine::detail::Site site_;
  std::optional<refine::detail::Judge> judge_;
};

}  // namespace scans
