// Planes moved to the samples on their own faces.
#include "mansard/refine/detail/refit.hpp"

#include "scans.hpp"

namespace {

using namespace scans;

/// Rise per run of the first roof that a plan's first edge carries.
auto slope_of(const Plan& plan) -> double {
  const auto& profile = plan.profiles[0];
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    if (const auto line = refine::detail::line_of(profile, i)) return line->slope;
  return 0;
}

TEST(Refit, makes_no_roof_steeper_than_any_that_is_proposed) {
  // What a scan makes of a wall that stands a metre inside of its footprint.
  const geometry::Ring ring = rectangle(0, 0, 14, 30);
  const auto of = [&](double slope) { return plan(ring, {roof(1, slope), wall(30), wall(30), wall(30)}, 30); };
  const auto mesh = scan({of(9)});
  refine::Options options;
  const auto refitted = [&] {
    const auto site = refine::detail::look({ring, {}}, ground, mesh, options);
    const auto judged = refine::detail::Judge(site, options, {}, {})(of(9));
    return judged ? slope_of(refine::detail::refitted(*judged, site, options)) : 0;
  };
  EXPECT_NEAR(refitted(), options.forms.max_slope, 1e-9);
  options.forms.max_slope = 12;
  EXPECT_NEAR(refitted(), 9, 1);
}

TEST(Refit, gives_gentle_roofs_their_pitch) {
  const geometry::Ring ring = rectangle(0, 0, 14, 10);
  const auto of = [&](double slope) { return plan(ring, {roof(4, slope), wall(30), wall(30), wall(30)}, 30); };
  const auto refitted = [&](double slope) {
    const auto mesh = scan({of(slope)});
    const refine::Options options;
    const auto site = refine::detail::look({ring, {}}, ground, mesh, options);
    const auto judged = refine::detail::Judge(site, options, {}, {})(of(0.02));
    return judged ? slope_of(refine::detail::refitted(*judged, site, options)) : 0;
  };
  EXPECT_NEAR(refitted(0.019), 0.019, 1e-4);  // 1.1°
  EXPECT_NEAR(refitted(5e-4), 0.001, 1e-9);   // no profile is level
}

}  // namespace
