// A piece of ground with the best roof that was found for it, and what may be done with pieces.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/roof_search.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

struct Piece {
  std::size_t draft_index = 0;
  Site site;
  Draft draft;
  Judged roof;
  std::optional<extrude::Raised> raised;  ///< in full; none until the search was thorough
  std::vector<std::string> changes;
};

/// Costs are in m²·m² throughout. Calls may run on any thread.
class Work {
 public:
  Work(const rays::Scene& mesh, const Options& options, const extrude::Options& raising, const base::Run& run)
      : mesh_(mesh), options_(options), raising_(raising), run_(run) {}

  [[nodiscard]] auto look(const geometry::Polygon& polygon, double base) const -> Site;

  /// `worth`: dearer roofs are of no interest. Gives up where the roof cannot be sketched, or, thoroughly searched, not
  /// be raised in full.
  [[nodiscard]] auto roofed(std::size_t draft_index, Site site, Draft draft, Search search = Search::thorough,
                            double worth = std::numeric_limits<double>::infinity()) const -> base::Result<Piece>;

  /// Two that touch under one roof, where that is cheaper.
  [[nodiscard]] auto as_one(const Piece& a, const Piece& b) const -> std::optional<Piece>;
  /// The pieces that are cheaper together than the one, if there are.
  [[nodiscard]] auto split(const Piece& piece) const -> std::vector<Piece>;
  /// Where two pieces meet in the wrong place: both as one, cut anew, if that is cheaper.
  [[nodiscard]] auto cut_anew(const Piece& a, const Piece& b) const -> std::vector<Piece>;

  /// The piece with its planes where they were before the scan melted them, where a solid can be made of that.
  [[nodiscard]] auto finished(Piece piece) const -> Piece;

  [[nodiscard]] auto options() const -> const Options& { return options_; }
  [[nodiscard]] auto cancelled() const -> bool { return run_.cancelled(); }

 private:
  [[nodiscard]] auto cut_within(const Piece& piece, double least_gain, double worth) const -> std::vector<Piece>;
  [[nodiscard]] auto cheapest(const Piece& piece, const std::vector<Proposal>& proposals, double worth) const
      -> std::vector<Piece>;
  [[nodiscard]] auto into_wings(const Piece& piece, double least_gain) const -> std::vector<Piece>;
  [[nodiscard]] auto misfit_about(const Piece& piece, geometry::Point2 place, double within) const -> double;
  [[nodiscard]] auto misfit_near(const Piece& piece, const geometry::Polygon& other) const -> double;
  [[nodiscard]] auto united(const Piece& a, const Piece& b, Search search, double worth) const -> std::optional<Piece>;
  [[nodiscard]] auto may_join(const Piece& a, const Piece& b) const -> bool;
  [[nodiscard]] auto tried(const Piece& piece, const Proposal& proposal, double worth) const -> std::vector<Piece>;
  [[nodiscard]] auto searched(const Piece& piece, const Proposal& proposal, std::vector<Piece> pieces) const
      -> std::vector<Piece>;

  const rays::Scene& mesh_;
  const Options& options_;
  const extrude::Options& raising_;
  const base::Run& run_;
};

}  // namespace mansard::refine::detail
