#include "mansard/refine/detail/owner.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/pieces.hpp"
#include "mansard/refine/detail/propose.hpp"
#include "mansard/refine/detail/roof_search.hpp"
#include "mansard/refine/detail/wings.hpp"

namespace mansard::refine::detail {
namespace {

/// A piece of ground with the best roof that was found for it.
struct Piece {
  std::size_t draft_index = 0;
  Site site;
  Draft draft;
  Judged roof;
  std::optional<extrude::Raised> raised;  ///< in full; none until the search was thorough
  std::vector<std::string> changes;
};

constexpr double any_cost = std::numeric_limits<double>::infinity();

class Work {
 public:
  Work(const rays::Scene& mesh, const Options& options, const extrude::Options& raising, const base::Run& run)
      : mesh_(mesh), options_(options), raising_(raising), run_(run) {}

  [[nodiscard]] auto look(const geometry::Polygon& polygon, double base) const -> Site {
    return detail::look(polygon, base, mesh_, options_);
  }

  /// `worth`: dearer roofs are of no interest.
  [[nodiscard]] auto roofed(std::size_t index, Site site, Draft draft, Search search = Search::thorough,
                            double worth = any_cost) const -> base::Result<Piece> {
    std::vector<std::string> changes;
    auto roof = best_roof(draft, Judge(site, options_, raising_, run_), search, worth, changes);
    if (!roof) return roof.error();
    Piece piece{index, std::move(site), std::move(draft), std::move(*roof), std::nullopt, std::move(changes)};
    if (search == Search::quick) return piece;
    auto raised = extrude::raise(piece.roof.plan, raising_, run_);
    if (!raised) return raised.error();
    if (raised->outcome != extrude::Outcome::full) return raised->warnings.back();
    piece.raised = std::move(*raised);
    return piece;
  }

  /// Joins two pieces at a time, those that save most first, until no pair saves anything.
  void join(std::vector<Piece>& pieces) const {
    struct Saving {
      double saved = 0;
      std::optional<Piece> piece;
    };
    std::map<std::pair<std::size_t, std::size_t>, Saving> pairs;  // by numbers that stay
    std::vector<std::size_t> number(pieces.size());
    for (std::size_t i = 0; i < number.size(); ++i) number[i] = i;
    std::size_t next = pieces.size();
    while (!run_.cancelled()) {
      std::pair<std::size_t, std::size_t> best{};
      double most = 0;
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (std::size_t j = i + 1; j < pieces.size(); ++j) {
          auto [at, is_new] = pairs.try_emplace(std::minmax(number[i], number[j]));
          if (is_new) {
            at->second.piece = as_one(pieces[i], pieces[j]);
            if (at->second.piece)
              at->second.saved =
                  pieces[i].roof.cost + pieces[j].roof.cost + options_.part_price - at->second.piece->roof.cost;
          }
          if (at->second.saved > most) {
            most = at->second.saved;
            best = {i, j};
          }
        }
      }
      if (!(most > 0)) return;
      const auto [i, j] = best;
      pieces[i] = std::move(*pairs.at(std::minmax(number[i], number[j])).piece);
      number[i] = next++;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
      number.erase(number.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }

  /// The pieces that are cheaper together than the one, if there are.
  [[nodiscard]] auto split(const Piece& piece) const -> std::vector<Piece> {
    const double least_gain = options_.part_price + 4 * options_.face_price;  // no solid has fewer faces
    if (run_.cancelled() || piece.roof.misfit < least_gain) return {};
    auto pieces = cut_within(piece, proposing(least_gain), piece.roof.cost);
    return pieces.empty() ? into_wings(piece, least_gain) : pieces;
  }

  /// Where two pieces meet in the wrong place: both as one, cut anew, if that is cheaper.
  [[nodiscard]] auto cut_anew(const Piece& a, const Piece& b) const -> std::vector<Piece> {
    const double least_gain = options_.part_price;
    if (run_.cancelled() || !touch(a, b)) return {};
    if (misfit_near(a, b.site.polygon) + misfit_near(b, a.site.polygon) < least_gain) return {};
    const double worth = a.roof.cost + b.roof.cost + options_.part_price;
    auto both = united(a, b, Search::quick, worth);
    if (!both) return {};
    return cut_within(*both, proposing(least_gain), worth - least_gain);
  }

 private:
  [[nodiscard]] auto proposing(double least_gain) const -> ProposeOptions {
    ProposeOptions wanted;
    wanted.least_area = options_.least_area;
    wanted.least_gain = least_gain;
    return wanted;
  }

  /// Of the proposed cuts the one whose pieces cost least, if that is less than they are worth.
  [[nodiscard]] auto cut_within(const Piece& piece, const ProposeOptions& wanted, double worth) const
      -> std::vector<Piece> {
    Heights model = piece.site.measured;
    model.z = piece.roof.view.z;
    return cheapest(piece, propose(piece.site.polygon, piece.site.measured, model, wanted), worth);
  }

  [[nodiscard]] auto cheapest(const Piece& piece, const std::vector<Proposal>& proposals, double worth) const
      -> std::vector<Piece> {
    struct Trial {
      double cost = 0;
      std::vector<Piece> pieces;
      const Proposal* proposal = nullptr;
    };
    std::vector<Trial> trials;
    for (const auto& proposal : proposals) {
      auto pieces = tried(piece, proposal, worth);
      if (pieces.empty()) continue;
      double cost = options_.part_price * static_cast<double>(pieces.size() - 1);
      for (const auto& one : pieces) cost += one.roof.cost;
      trials.push_back({cost, std::move(pieces), &proposal});
    }
    std::ranges::stable_sort(trials, {}, &Trial::cost);
    for (auto& trial : trials) {
      auto pieces = searched(piece, *trial.proposal, std::move(trial.pieces));
      if (!pieces.empty()) return pieces;
    }
    return {};
  }

  /// The same of the cuts between wings, those with most misfit about them.
  [[nodiscard]] auto into_wings(const Piece& piece, double least_gain) const -> std::vector<Piece> {
    constexpr std::size_t most = 12;  // cuts tried
    std::vector<Proposal> wings;
    for (auto& wing : wings_of(piece.site.polygon)) {
      const double about = misfit_about(piece, wing.middle, wing.length);
      if (about >= least_gain) wings.push_back({std::move(wing.polygon), about, 0, "a wing", true});
    }
    std::ranges::stable_sort(wings, std::greater<>{}, &Proposal::gain);
    if (wings.size() > most) wings.resize(most);
    return cheapest(piece, wings, piece.roof.cost);
  }

  /// m²·m²: squared differences of the looks around a place.
  [[nodiscard]] auto misfit_about(const Piece& piece, geometry::Point2 place, double within) const -> double {
    const auto& site = piece.site;
    double sum = 0;
    for (std::size_t i = 0; i < site.cells.size(); ++i) {
      const auto cell = site.cells[i];
      const auto off = site.measured.centre(cell % site.measured.columns, cell / site.measured.columns) - place;
      const double d = std::abs(piece.roof.view.z[cell] - site.measured.z[cell]);
      if (dot(off, off) < within * within && !std::isnan(d)) sum += site.weight[i] * d * std::min(d, options_.robust);
    }
    return sum * site.cell_area;
  }

  /// Both under one roof, where their grounds make one polygon.
  [[nodiscard]] auto united(const Piece& a, const Piece& b, Search search, double worth) const -> std::optional<Piece> {
    const auto polygon = joined(a.site.polygon, b.site.polygon);
    if (!polygon) return std::nullopt;
    Site site = look(*polygon, a.site.base);
    const Origin origins[]{{a.draft, a.roof.plan}, {b.draft, b.roof.plan}};
    Draft draft = draft_of(origins, site);
    auto made = roofed(std::min(a.draft_index, b.draft_index), std::move(site), std::move(draft), search, worth);
    if (!made) return std::nullopt;
    return std::move(*made);
  }

  /// The same where that is cheaper.
  [[nodiscard]] auto as_one(const Piece& a, const Piece& b) const -> std::optional<Piece> {
    if (!may_join(a, b)) return std::nullopt;
    const double worth = a.roof.cost + b.roof.cost + options_.part_price;
    auto made = united(a, b, Search::thorough, worth);
    if (!made || made->roof.cost >= worth) return std::nullopt;
    made->changes.insert(made->changes.begin(), "two parts joined under one roof");
    return made;
  }

  /// Whether their grounds may meet, and there is anything to see over them.
  [[nodiscard]] static auto touch(const Piece& a, const Piece& b) -> bool {
    constexpr double touching = 0.05;  // m
    const auto box = geometry::bounds(a.site.polygon.outer).grown(touching);
    return box.overlaps(geometry::bounds(b.site.polygon.outer)) && !a.site.sorted.empty() && !b.site.sorted.empty();
  }

  /// m²·m²: of the squared differences above half a metre, those along the other's ground.
  [[nodiscard]] auto misfit_near(const Piece& piece, const geometry::Polygon& other) const -> double {
    constexpr double step = 0.5, near = 1.5;  // m
    const auto& site = piece.site;
    double sum = 0;
    for (const auto cell : site.cells) {
      const double d = std::abs(piece.roof.view.z[cell] - site.measured.z[cell]);
      if (!(d > step)) continue;
      const auto at = site.measured.centre(cell % site.measured.columns, cell / site.measured.columns);
      if (geometry::boundary_distance(other, at) < near) sum += d * std::min(d, options_.robust);
    }
    return sum * site.cell_area;
  }

  /// Whether two that touch may be cheaper as one: two flat roofs too far apart are not.
  [[nodiscard]] auto may_join(const Piece& a, const Piece& b) const -> bool {
    if (!touch(a, b)) return false;
    const auto level = [](const Piece& piece) -> std::optional<double> {
      for (const auto& profile : piece.roof.plan.profiles)
        if (profile.back().inward > 0) return std::nullopt;
      return piece.roof.plan.cap;
    };
    const auto low = level(a), high = level(b);
    if (!low || !high) return true;
    const double area = std::min(geometry::area(a.site.polygon), geometry::area(b.site.polygon));
    const double step = std::abs(*high - *low);
    constexpr std::size_t shared = 8;  // faces that joining may save at most, about
    return area * std::min(step * step, options_.robust * step) < options_.part_price + shared * options_.face_price;
  }

  /// The pieces of a cut, each with a roof found quickly; none where they cost more than they are worth.
  [[nodiscard]] auto tried(const Piece& piece, const Proposal& proposal, double worth) const -> std::vector<Piece> {
    std::vector<Piece> out;
    double left = worth;
    const Origin origin[]{{piece.draft, piece.roof.plan}};
    for (const auto& polygon : cut(piece.site.polygon, proposal.polygon, options_.least_area)) {
      Site site = crop(piece.site, polygon, options_);
      if (site.cells.empty()) return {};
      Draft draft = draft_of(origin, site);
      auto made = roofed(piece.draft_index, std::move(site), std::move(draft), Search::quick, left);
      if (!made) return {};
      left -= made->roof.cost + (out.empty() ? 0 : options_.part_price);
      if (left <= 0) return {};
      out.push_back(std::move(*made));
    }
    return out;
  }

  /// The same pieces searched thoroughly; none where a sketch is one that no solid can be made of.
  [[nodiscard]] auto searched(const Piece& piece, const Proposal& proposal, std::vector<Piece> pieces) const
      -> std::vector<Piece> {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      auto better = roofed(piece.draft_index, std::move(pieces[i].site), std::move(pieces[i].draft));
      if (!better) return {};
      pieces[i] = std::move(*better);
      auto& changes = pieces[i].changes;
      if (i == 0)
        changes.insert(changes.begin(), piece.changes.begin(), piece.changes.end());
      else
        changes.insert(changes.begin(), "a part of its own: " + proposal.what);
    }
    return pieces;
  }

  const rays::Scene& mesh_;
  const Options& options_;
  const extrude::Options& raising_;
  const base::Run& run_;
};

/// Cuts pieces, and the pieces of pieces, as long as that pays.
auto all_split(std::vector<Piece> open, const Work& work) -> std::vector<Piece> {
  constexpr std::size_t most_pieces = 64;  // an owner that needs more is not told by straight cuts
  std::vector<Piece> done;
  while (!open.empty()) {
    Piece piece = std::move(open.front());
    open.erase(open.begin());
    std::vector<Piece> pieces;
    if (done.size() + open.size() < most_pieces) pieces = work.split(piece);
    if (pieces.empty())
      done.push_back(std::move(piece));
    else
      open.insert(open.begin(), std::make_move_iterator(pieces.begin()), std::make_move_iterator(pieces.end()));
  }
  return done;
}

/// Moves walls between pieces by cutting pairs anew.
void cut_all_anew(std::vector<Piece>& pieces, const Work& work) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      auto anew = work.cut_anew(pieces[i], pieces[j]);
      if (anew.empty()) continue;
      pieces[i] = std::move(anew.front());
      pieces[j] = std::move(anew[1]);
      pieces.insert(pieces.end(), std::make_move_iterator(anew.begin() + 2), std::make_move_iterator(anew.end()));
    }
  }
}

auto cost_of(const std::vector<Piece>& pieces, const Options& options) -> double {
  double cost = 0;
  for (const auto& piece : pieces) cost += piece.roof.cost + options.part_price;
  return cost;
}

}  // namespace

auto refine_owner(std::span<const Draft> drafts, std::span<const std::size_t> mine, const rays::Scene& mesh,
                  const Options& options, const extrude::Options& raising, const base::Run& run) -> Refined {
  Refined out;
  const Work work(mesh, options, raising, run);
  std::vector<Piece> pieces;
  for (const std::size_t i : mine) {
    const auto& plan = drafts[i].plan;
    auto piece = work.roofed(i, work.look(geometry::polygon_of(plan), plan.base), drafts[i]);
    if (piece) {
      pieces.push_back(std::move(*piece));
    } else if (auto raised = extrude::raise(plan, raising, run)) {  // down the ladder, and no further
      out.parts.push_back({drafts[i].owner, i, plan, std::move(*raised), {}});
    } else {
      out.failed.emplace_back(i, raised.error());
    }
  }
  if (options.effort == Effort::parts) {
    constexpr int rounds = 2;  // what one step leaves behind may be what another needed
    for (int round = 0; round < rounds; ++round) {
      const double before = cost_of(pieces, options);
      work.join(pieces);
      pieces = all_split(std::move(pieces), work);
      cut_all_anew(pieces, work);
      constexpr double enough = 0.95;
      if (cost_of(pieces, options) > enough * before) break;
    }
  }
  for (auto& piece : pieces)
    out.parts.push_back({piece.draft.owner, piece.draft_index, std::move(piece.roof.plan), std::move(*piece.raised),
                         std::move(piece.changes)});
  return out;
}

}  // namespace mansard::refine::detail
