#include "forall.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "families.hpp"
#include "minimise.hpp"

namespace plans {
namespace {

auto environment(const char* name) -> std::string {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

auto share_of_runs(int per_mille) -> int {
  constexpr double in_a_test_run = 5000;
  const std::string given = environment("MANSARD_RUNS");
  const double all = given.empty() ? in_a_test_run : std::atof(given.c_str());
  return std::max(1, static_cast<int>(std::lround(all * per_mille / 1000)));
}

}  // namespace

void for_all_plans(int per_mille, std::size_t size, const Property& property) {
  const auto guarded = [&](const Plan& plan) -> std::string {
    try {
      return property(plan);
    } catch (const std::exception& e) {
      return std::string("exception: ") + e.what();
    }
  };
  const auto kind = [](const std::string& fault) { return fault.substr(0, fault.find(' ')); };
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();

  const std::string given = environment("RC_PARAMS");
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  if (given.find("seed=") == std::string::npos) params.seed = 20111126;  // a test run is the same every time
  if (given.find("max_success=") == std::string::npos) params.maxSuccess = share_of_runs(per_mille);
  params.disableShrinking = true;  // a smaller seed is no smaller plan

  const auto result = rc::detail::checkTestable(
      [&] {
        const auto seed =
            *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>()).as("seed of the plan");
        const auto corners = *rc::gen::inRange<std::size_t>(4, size + 1).as("size of the plan");
        const Plan plan = family_plan(seed, corners);
        const std::string fault = guarded(plan);
        if (fault.empty()) return;
        const Plan small = minimised(
            plan, [&](const Plan& p) { return kind(guarded(p)) == kind(fault); }, 1500);
        const std::string kept = keep_failure(small, MANSARD_TEST_DATA "/fixtures", test->name());
        RC_FAIL(guarded(small) + "\n" + to_json(small) + (kept.empty() ? "" : "\nkept as " + kept));
      },
      rc::detail::TestMetadata{std::string(test->test_suite_name()) + "/" + test->name(), test->name()}, params);
  if (result.is<rc::detail::SuccessResult>()) return;
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  FAIL() << message.str() << "\nAgain: RC_PARAMS=\"seed=" << params.seed << " max_success=" << params.maxSuccess
         << "\"";
}

}  // namespace plans
