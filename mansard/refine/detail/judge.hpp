// A plan raised, seen from above and held against the mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/refine/detail/account.hpp"
#include "mansard/refine/detail/bare.hpp"
#include "mansard/refine/detail/known.hpp"
#include "mansard/refine/detail/site.hpp"
#include "mansard/refine/detail/view.hpp"

namespace mansard::refine::detail {

/// Squared up to `robust`, linear beyond (P. Huber, Robust estimation of a location parameter, 1964).
[[nodiscard]] inline auto loss(double difference, double robust) -> double {
  const double d = std::abs(difference);
  return d <= robust ? d * d : robust * (2 * d - robust);
}

/// m: up to where a difference counts squared. Beside the outline of a building (`beside`, of Site::limits) the scan
/// falls to the ground, so that less of what a roof is above it does.
[[nodiscard]] inline auto limit_of(double above, double beside, double robust) -> double {
  return above > 0 ? std::min(beside, robust) : robust;
}

/// Squared up to `stray`, and the same beyond: a point that is farther off is of something else, a plant, a wire, the
/// ground in a gap, and no roof suits it better for coming a little nearer (P. Huber and E. Ronchetti, Robust
/// Statistics, 2009, section 4.8: redescending estimates).
[[nodiscard]] inline auto stray_loss(double difference, double stray) -> double {
  return std::min(difference * difference, stray * stray);
}

struct Judged {
  model::Plan plan;
  model::Solid sketch;
  View view;
  double misfit = 0;                ///< m² · m²: weighed robust squared differences times their area
  std::vector<std::uint32_t> bare;  ///< faces that nothing of the scan speaks for
  double unsupported = 0;           ///< m² · m²: what those pay
  double cost = 0;                  ///< misfit, the price of the faces, and what is unsupported
};

class Judge {
 public:
  /// `known`: of this site, these options and no others; what is judged is added. Null: every roof is made. `account`:
  /// pays for every roof that is asked for.
  Judge(const Site& site, const Options& options, const extrude::Options& raising, const base::Run& run,
        KnownRoofs* known = nullptr, Account* account = nullptr)
      : site_(site), options_(options), raising_(raising), run_(run), known_(known), account_(account) {}

  /// Gives up where the plan cannot be raised in full.
  [[nodiscard]] auto operator()(const model::Plan& plan) const -> base::Result<Judged>;

  /// The same where it is cheaper (order.hpp) than that; none where it is not, or cannot be raised. What is too dear is
  /// mostly known before all of it was compared.
  [[nodiscard]] auto cheaper(const model::Plan& plan, double than) const -> std::optional<Judged>;

  /// Whether a solid can be made of the plan as it is, and not only a sketch.
  [[nodiscard]] auto stands(const model::Plan& plan) const -> bool {
    const auto raised = extrude::raise(plan, raising_, run_);
    return raised && raised->outcome == extrude::Outcome::full;
  }

  /// m²·m²: of a roof, cut off at `cap`, m above the base. A sum that reaches `most` together with what is `paid`
  /// already may end there.
  [[nodiscard]] auto misfit_of(const View& view, double cap = std::numeric_limits<double>::infinity(),
                               double most = std::numeric_limits<double>::infinity(), double paid = 0) const -> double;

  /// m²·m²: of the misfit, what other planes might explain. Of points, what is left off the planes that the scan itself
  /// shows is noise, which no roof explains; of a surface, all.
  [[nodiscard]] auto reducible(const Judged& judged) const -> double;
  /// The same of one sample, over the area of a sample; it may be negative.
  [[nodiscard]] auto reducible_at(const Judged& judged, std::size_t sample) const -> double;
  /// m²·m²: what another roof may save at most, beside faces.
  [[nodiscard]] auto wrong(const Judged& judged) const -> double { return reducible(judged) + judged.unsupported; }

  /// Whether no more roofs are to be asked for, one after the other: there were enough, or they took as much as all
  /// that is done with a building of that size may take. Only where no other thread asks.
  [[nodiscard]] auto is_tired(const model::Plan& plan) const -> bool {
    const auto asked = asked_.load(std::memory_order_relaxed);
    const auto corners = corners_of(plan);
    const bool tired =
        asked >= static_cast<std::uint64_t>(options_.search.most_roofs) ||
        asked * work_of(site_, corners) >= most_work_of(samples_of(site_), corners, options_.search.most_work);
    if (tired && account_) account_->met_a_bound();
    return tired;
  }

  [[nodiscard]] auto site() const -> const Site& { return site_; }
  [[nodiscard]] auto options() const -> const Options& { return options_; }

 private:
  /// None where it costs at least that much.
  [[nodiscard]] auto of(const model::Plan& plan, model::Solid sketch, double most) const -> std::optional<Judged>;
  /// If it is known; seen from above only where it costs less than that.
  [[nodiscard]] auto again(const model::Plan& plan, double most) const -> std::optional<Judged>;
  /// The same of a roof of which the view lacks the samples, points: they are added as far as it goes.
  [[nodiscard]] auto misfit_of_points(const model::Solid& sketch, View& view, double most, double paid) const -> double;
  /// m²·m², over the area of a sample: of one that is a point.
  [[nodiscard]] auto loss_at(const View& view, std::size_t sample, double cap) const -> double;
  /// m²·m²: a misfit, and that of a roof above the crowns that hide it.
  [[nodiscard]] auto with_ceilings(const View& view, double cap, double misfit) const -> double;
  void pay_for(const model::Plan& plan) const {
    asked_.fetch_add(1, std::memory_order_relaxed);
    if (account_) account_->add(work_of(site_, corners_of(plan)));
  }
  /// Fills in what is unsupported costs, and the sum with what the faces cost.
  void price(Judged& judged, double faces) const;

  const Site& site_;
  const Options& options_;
  const extrude::Options& raising_;
  const base::Run& run_;
  KnownRoofs* known_;
  Account* account_;
  mutable std::atomic<std::uint64_t> asked_{0};
};

}  // namespace mansard::refine::detail
