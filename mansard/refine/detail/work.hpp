// A piece of ground with the best roof that was found for it, and what may be done with pieces.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/roof_search.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

struct Dormer;

struct Piece {
  std::size_t draft_index = 0;
  Site site;
  Draft draft;
  Judged roof;
  std::optional<extrude::Raised> raised;  ///< in full; none until the search was thorough
  std::vector<std::string> changes;
  std::optional<Site> whole = {};          ///< with the dormers, where the site is without
  std::shared_ptr<Piece> plain = {};       ///< as it is best without dormers, where the site is without
  std::shared_ptr<KnownRoofs> known = {};  ///< over its site, while it may be searched more thoroughly
  std::size_t number = 0;  ///< no other piece of its owner ever has it: what was tried with it is known by it
};

/// Two pieces under one roof that was found quickly.
struct Union {
  geometry::Polygon polygon;
  Draft draft;
  Judged roof;
  std::shared_ptr<KnownRoofs> known;  ///< over the ground of both
};

/// Costs are in m²·m² throughout. Calls may run on any thread.
class Work {
 public:
  Work(const rays::Scene& mesh, const rays::Scene* above, const Options& options, const extrude::Options& raising,
       const base::Run& run)
      : mesh_(mesh), above_(above), options_(options), raising_(raising), run_(run) {
    if (options.samples.point_area > 0) points_ = std::make_shared<const Evidence>(mesh, options);
  }
  /// The same with an account of its own.
  [[nodiscard]] auto for_owner() const -> Work {
    Work work = *this;
    work.account_ = std::make_shared<Account>();
    return work;
  }
  [[nodiscard]] auto account() const -> Account& { return *account_; }

  [[nodiscard]] auto look(const geometry::Polygon& polygon, double base) const -> Site;

  /// `worth`: dearer roofs are of no interest. `known`, `found`: of an earlier search over the same site, all roofs and
  /// the best. Gives up where the roof cannot be sketched, or, thoroughly searched, not be raised in full.
  [[nodiscard]] auto roofed(std::size_t draft_index, Site site, Draft draft, Search search = Search::thorough,
                            double worth = std::numeric_limits<double>::infinity(),
                            std::shared_ptr<KnownRoofs> known = nullptr, const Judged* found = nullptr) const
      -> base::Result<Piece>;

  /// Whether their grounds may meet, and there is anything to see over them.
  [[nodiscard]] auto touch(const Piece& a, const Piece& b) const -> bool;
  /// m²·m²: of the squared differences above a step, those of each along the other's ground.
  [[nodiscard]] auto misfit_between(const Piece& a, const Piece& b) const -> double;
  /// Both under one roof, found quickly, where their grounds make one polygon.
  [[nodiscard]] auto united(const Piece& a, const Piece& b) const -> std::optional<Union>;
  /// Whether two that touch may be cheaper as one.
  [[nodiscard]] auto may_join(const Piece& a, const Piece& b) const -> bool;
  /// Two under one roof, searched thoroughly, where that is cheaper.
  [[nodiscard]] auto as_one(const Piece& a, const Piece& b, const Union& both) const -> std::optional<Piece>;
  /// The pieces that are cheaper together than the one, if there are.
  [[nodiscard]] auto split(const Piece& piece) const -> std::vector<Piece>;
  /// Where two pieces meet in the wrong place: both as one, cut anew, if that is cheaper.
  [[nodiscard]] auto cut_anew(const Piece& a, const Piece& b, const Union& both) const -> std::vector<Piece>;
  /// Whether enough is wrong where they meet.
  [[nodiscard]] auto may_cut_anew(const Piece& a, const Piece& b) const -> bool;
  /// The same with a price for each: what one roof, or another cut, has to beat.
  [[nodiscard]] auto cost_of(const Piece& a, const Piece& b) const -> double {
    return a.roof.cost + b.roof.cost + options_.part_price;
  }

  /// The piece with its planes where they were before the scan melted them, where a solid can be made of that.
  [[nodiscard]] auto finished(Piece piece) const -> Piece;
  /// The piece with a hole for every dormer on it, and the dormers; the piece alone where there are none.
  [[nodiscard]] auto with_dormers(Piece piece) const -> std::vector<Piece>;
  /// The piece under another roof; none where that costs more, or no solid can be made of it.
  [[nodiscard]] auto with_roof(const Piece& piece, const model::Plan& plan, double most) const -> std::optional<Piece>;
  [[nodiscard]] auto raised(const model::Plan& plan) const { return extrude::raise(plan, raising_, run_); }

  [[nodiscard]] auto options() const -> const Options& { return options_; }
  [[nodiscard]] auto cancelled() const -> bool { return run_.cancelled(); }

 private:
  [[nodiscard]] auto judge_of(const Site& site, KnownRoofs* known = nullptr) const -> Judge {
    return {site, options_, raising_, run_, known, account_.get()};
  }
  [[nodiscard]] auto beside_dormers(const Piece& piece, double most) const -> std::optional<Piece>;
  [[nodiscard]] auto dormers_of(const Judged& roof, const Site& all) const -> std::pair<std::vector<Dormer>, double>;
  [[nodiscard]] auto with_ceilings(Site site) const -> Site;
  [[nodiscard]] auto without_remnants(Site site) const -> Site;
  [[nodiscard]] auto both_of(const Piece& a, const Piece& b, const geometry::Polygon& both) const -> Site;
  [[nodiscard]] auto cut_within(const Piece& piece, double least_gain, double worth) const -> std::vector<Piece>;
  [[nodiscard]] auto cheapest(const Piece& piece, const std::vector<Proposal>& proposals, double worth) const
      -> std::vector<Piece>;
  [[nodiscard]] auto cuts_of(const Piece& piece, double least_gain) const -> std::vector<Proposal>;
  [[nodiscard]] auto wings_of(const Piece& piece, double least_gain) const -> std::vector<Proposal>;
  [[nodiscard]] auto cost_instead(const Piece& whole, const std::vector<Piece>& pieces) const -> double;
  [[nodiscard]] auto hidden(const Site& whole, const Judged& roof, std::span<const Piece* const> pieces) const
      -> double;
  [[nodiscard]] auto misfit_about(const Piece& piece, geometry::Point2 place, double within) const -> double;
  [[nodiscard]] auto misfit_near(const Piece& piece, const geometry::Polygon& other) const -> double;
  [[nodiscard]] auto cost_of_faces(const geometry::Polygon& polygon) const -> double;
  [[nodiscard]] auto tried(const Piece& piece, const Proposal& proposal, double worth) const -> std::vector<Piece>;
  [[nodiscard]] auto searched(const Piece& piece, const Proposal& proposal, std::vector<Piece> pieces) const
      -> std::vector<Piece>;

  const rays::Scene& mesh_;
  std::shared_ptr<const Evidence> points_;  ///< of a scan that consists of points
  std::shared_ptr<Account> account_ = std::make_shared<Account>();
  const rays::Scene* above_;  ///< with the crowns of trees; null where there are none
  const Options& options_;
  const extrude::Options& raising_;
  const base::Run& run_;
};

}  // namespace mansard::refine::detail
