// A plan raised, seen from above and held against the mesh.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/refine/detail/bare.hpp"
#include "mansard/refine/detail/site.hpp"
#include "mansard/refine/detail/view.hpp"

namespace mansard::refine::detail {

/// Squared up to `robust`, linear beyond (P. Huber, Robust estimation of a location parameter, 1964).
[[nodiscard]] inline auto loss(double difference, double robust) -> double {
  const double d = std::abs(difference);
  return d <= robust ? d * d : robust * (2 * d - robust);
}

struct Judged {
  model::Plan plan;
  model::Solid sketch;
  View view;
  double misfit = 0;                ///< m² · m²: weighed robust squared differences times their area
  std::vector<std::uint32_t> bare;  ///< faces that nothing of the scan speaks for
  double unsupported = 0;           ///< m² · m²: what those pay
  double cost = 0;                  ///< misfit, the price of the faces, and what is unsupported
  /// m² · m²: what another roof may save at most, beside faces.
  [[nodiscard]] auto wrong() const -> double { return misfit + unsupported; }
};

class Judge {
 public:
  Judge(const Site& site, const Options& options, const extrude::Options& raising, const base::Run& run)
      : site_(site), options_(options), raising_(raising), run_(run) {}

  /// Gives up where the plan cannot be raised in full.
  [[nodiscard]] auto operator()(const model::Plan& plan) const -> base::Result<Judged>;

  /// m²·m²: of heights on the site's grid, cut off at `cap`, m above the base; NaN where there are none.
  [[nodiscard]] auto misfit_of(const std::vector<double>& z, double cap = std::numeric_limits<double>::infinity()) const
      -> double;

  [[nodiscard]] auto site() const -> const Site& { return site_; }
  [[nodiscard]] auto options() const -> const Options& { return options_; }

 private:
  const Site& site_;
  const Options& options_;
  const extrude::Options& raising_;
  const base::Run& run_;
};

}  // namespace mansard::refine::detail
