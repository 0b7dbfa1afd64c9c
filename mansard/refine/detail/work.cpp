#include "mansard/refine/detail/work.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/rays/hidden.hpp"
#include "mansard/refine/detail/dormers.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/pieces.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/rims.hpp"
#include "mansard/refine/detail/sharpen.hpp"
#include "mansard/refine/detail/tall.hpp"
#include "mansard/refine/detail/wings.hpp"

namespace mansard::refine::detail {

using geometry::Point2;

namespace {

/// Limits on the search, shares of what is wrong with a part: of what a cut must explain to be tried, and of what must
/// lie along a seam for both parts to be cut anew. Cluttered roofs have hundreds of steps that explain next to nothing;
/// b9 takes 47 CPU s with these and 100 without, with the same error (27 November 2026).
constexpr double worth_a_cut = 0.02, worth_a_seam = 0.05;

/// Where two meet in the wrong place, one roof over both costs more than two by what a cut has to explain, and by what
/// a quick search leaves. Of those cuts that explain less than half, one in twenty pays (decision 154).
constexpr double least_explained = 0.5;

/// Of what a wing's own roof saves, simple surfaces explain a part: its end may be hipped, its valley runs askew. Of
/// 164 wings in simulated scans that these explain less of, none was worth a cut (decision 168).
constexpr double explained_of_wing = 0.25;

/// m: z of a roof at a place over it, or beside it, where its nearest face goes on; NaN farther away.
auto z_beside(const Judged& roof, const Site& site, Point2 place) -> double {
  constexpr long reach = 2;  // cells
  const auto& grid = site.measured;
  const auto near = [&](double at, double origin, std::size_t count) {
    const long middle = std::lround((at - origin) / grid.spacing), end = static_cast<long>(count);
    return std::pair{std::clamp(middle - reach, 0L, end), std::clamp(middle + reach + 1, 0L, end)};
  };
  const auto columns = near(place.x, grid.origin.x, grid.columns), rows = near(place.y, grid.origin.y, grid.rows);
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (auto row = static_cast<std::size_t>(rows.first); row < static_cast<std::size_t>(rows.second); ++row)
    for (auto column = static_cast<std::size_t>(columns.first); column < static_cast<std::size_t>(columns.second);
         ++column) {
      const std::size_t cell = row * grid.columns + column;
      const Point2 from = grid.centre(column, row) - place;
      if (const double d = dot(from, from); !std::isnan(roof.view.z[cell]) && d < least) least = d, nearest = cell;
    }
  if (!nearest) return std::numeric_limits<double>::quiet_NaN();
  const auto& face = roof.sketch.faces[roof.view.face[*nearest]];
  const auto& on = roof.sketch.vertices[face.loops.front().front()];
  return on.z - dot(xy(face.normal), place - xy(on)) / face.normal.z;
}

/// What a crown hides may be joined with what is seen beside it.
auto may_be_known(const Piece& piece) -> bool { return !piece.site.cells.empty() || !piece.site.ceilings.empty(); }

auto on_planes_of(const Site& site) -> OnPlanes {
  if (site.plane_of.empty()) return {};
  return {site.places, site.plane_of, site.z, site.sample_area, site.of_points};
}

auto square_metres(const Piece& piece) -> std::string {
  return base::to_text(geometry::area(piece.site.polygon), 1) + " m²";
}

/// In full, and as it was planned: a solid that only a nudge makes a manifold has strips and needles there.
auto is_sound(const base::Result<extrude::Raised>& raised) -> bool {
  return raised && raised->outcome == extrude::Outcome::full &&
         std::ranges::none_of(raised->warnings, [](const auto& warning) { return warning.code == "extrude-nudged"; });
}

/// Whether most samples over a piece lie on its roof: of crowns, and of gaps through which some points show the ground,
/// few do. Clearly more than half, within the smallest detail or twice what a fit of lines takes for noise; chosen by
/// hand (decisions 137 and 155).
auto is_of_roof(const Piece& piece, const Options& options) -> bool {
  constexpr double most = 0.6, noises = 2;
  const double near = std::max(options.detail, noises * options.lines.robust);
  const Site& site = piece.site;
  std::size_t on = 0, clear = 0;
  for (std::size_t i = 0; i < site.z.size(); ++i) {
    if (site.weight[i] < 1) continue;
    ++clear;
    if (std::abs(piece.roof.view.z_of(site, i) - site.z[i]) <= near) ++on;
  }
  return static_cast<double>(on) >= most * static_cast<double>(clear);
}

}  // namespace

auto Work::look(const geometry::Polygon& polygon, double base) const -> Site {
  return without_remnants(with_ceilings(detail::look(polygon, base, mesh_, options_, points_.get())));
}

/// Nothing is seen of what crowns hide but for the ground beside it.
auto Work::without_remnants(Site site) const -> Site {
  if (site.cells.empty() || site.ceilings.empty()) return site;
  std::vector<double> all = site.sorted;
  for (const auto& [cell, height] : site.ceilings) all.push_back(height);
  std::ranges::sort(all);
  if (!rays::hidden_height(site.sorted, all)) return site;
  return with_ceilings(detail::without_cells(site, options_));
}

auto Work::with_ceilings(Site site) const -> Site {
  if (above_) add_ceilings(site, *above_);
  return site;
}

auto Work::both_of(const Piece& a, const Piece& b, const geometry::Polygon& both) const -> Site {
  return with_ceilings(merged(a.site, b.site, both, mesh_, options_, points_.get()));
}

/// `worth`: dearer roofs are of no interest.
auto Work::roofed(std::size_t draft_index, Site site, Draft draft, Search search, double worth,
                  std::shared_ptr<KnownRoofs> known, const Judged* found) const -> base::Result<Piece> {
  std::vector<std::string> changes;
  if (!known) known = std::make_shared<KnownRoofs>();
  auto roof = best_roof(draft, judge_of(site, known.get()), search, worth, found, changes);
  if (!roof) return roof.error();
  Piece piece{draft_index, std::move(site), std::move(draft), std::move(*roof), std::nullopt, std::move(changes)};
  if (search != Search::thorough) {
    piece.known = std::move(known);
    return piece;
  }
  auto raised = extrude::raise(piece.roof.plan, raising_, run_);
  if (!raised) return raised.error();
  if (raised->outcome != extrude::Outcome::full) return raised->warnings.back();
  piece.raised = std::move(*raised);
  return piece;
}

/// The pieces that are cheaper together than the one, if there are.
auto Work::split(const Piece& piece) const -> std::vector<Piece> {
  constexpr double fewest_faces = 4;  // a tetrahedron's: no solid has fewer
  const double least_gain =
      std::max(options_.part_price + fewest_faces * options_.face_price, worth_a_cut * piece.roof.misfit);
  if (run_.cancelled() || judge_of(piece.site).reducible(piece.roof) < least_gain) return {};
  auto proposals = cuts_of(piece, least_gain);
  std::ranges::move(wings_of(piece, least_gain), std::back_inserter(proposals));
  std::ranges::move(within_rims(piece.site, piece.roof.view, least_gain, options_), std::back_inserter(proposals));
  return cheapest(piece, proposals, piece.roof.cost);
}

auto Work::touch(const Piece& a, const Piece& b) const -> bool {
  const auto box = geometry::bounds(a.site.polygon.outer).grown(options_.joins.touching);
  return box.overlaps(geometry::bounds(b.site.polygon.outer)) && may_be_known(a) && may_be_known(b) &&
         !(a.site.cells.empty() && b.site.cells.empty());
}

auto Work::misfit_between(const Piece& a, const Piece& b) const -> double {
  return misfit_near(a, b.site.polygon) + misfit_near(b, a.site.polygon);
}

auto Work::may_cut_anew(const Piece& a, const Piece& b) const -> bool {
  return misfit_between(a, b) >= std::max(options_.face_price, worth_a_seam * (a.roof.misfit + b.roof.misfit));
}

/// Where two pieces meet in the wrong place: both as one, cut anew, if that is cheaper.
auto Work::cut_anew(const Piece& a, const Piece& b, const Union& both) const -> std::vector<Piece> {
  const Piece one{
      std::min(a.draft_index, b.draft_index), both_of(a, b, both.polygon), both.draft, both.roof, std::nullopt, {}};
  const Piece* const pair[]{&a, &b};
  const double worth = cost_of(a, b) + hidden(one.site, one.roof, pair) - options_.face_price;
  std::vector<Proposal> seams;
  for (const Piece* piece : pair) {
    auto moved = at_steps(both.polygon, piece->site.polygon, one.site.measured, on_planes_of(one.site), options_);
    if (moved && moved->outer != piece->site.polygon.outer)
      seams.push_back({std::move(*moved), misfit_between(a, b), "its wall where the scan has it", false});
  }
  auto pieces = cheapest(one, seams, worth);
  return pieces.empty() ? cut_within(one, options_.face_price, worth) : pieces;
}

/// Of the proposed cuts the one whose pieces cost least, if that is less than they are worth.
auto Work::cut_within(const Piece& piece, double least_gain, double worth) const -> std::vector<Piece> {
  return cheapest(piece, cuts_of(piece, std::max(least_gain, least_explained * (piece.roof.cost - worth))), worth);
}

auto Work::cuts_of(const Piece& piece, double least_gain) const -> std::vector<Proposal> {
  account_->add(work_of_cut * piece.site.cells.size());
  Heights model = piece.site.measured, measured = piece.site.measured;
  model.z = piece.roof.view.z;
  // Where the roof is above the crown that hides it, that is known.
  for (const auto& [cell, ceiling] : piece.site.ceilings)
    if (model.z[cell] > ceiling) measured.z[cell] = ceiling;
  return propose(piece.site.polygon, measured, model, least_gain, options_, on_planes_of(piece.site));
}

auto Work::cheapest(const Piece& piece, const std::vector<Proposal>& proposals, double worth) const
    -> std::vector<Piece> {
  struct Trial {
    double cost = 0;
    std::vector<Piece> pieces;
    const Proposal* proposal = nullptr;
  };
  std::vector<Trial> trials(proposals.size());
  base::parallel_for(proposals.size(), [&](std::size_t k) {
    auto& [cost, pieces, proposal] = trials[k];
    proposal = &proposals[k];
    pieces = tried(piece, *proposal, worth);
    if (pieces.empty()) return;
    cost = cost_instead(piece, pieces);
    if (!cheaper(cost, worth, options_.same_cost)) pieces.clear();
  });
  std::erase_if(trials, [](const Trial& trial) { return trial.pieces.empty(); });
  rank(trials, &Trial::cost, options_.same_cost);
  const auto needles = [this](const std::vector<Piece>& pieces) {
    return std::ranges::any_of(pieces,
                               [this](const Piece& one) { return is_needle(one.site, one.roof, mesh_, options_); });
  };
  for (auto& trial : trials) {
    if (needles(trial.pieces)) continue;
    auto pieces = searched(piece, *trial.proposal, std::move(trial.pieces));
    // What was found quickly is no promise: pieces that cost more in the end would be cut again for ever.
    if (!pieces.empty() && !needles(pieces) && cheaper(cost_instead(piece, pieces), worth, options_.same_cost))
      return pieces;
  }
  return {};
}

/// m²·m²: what pieces of a piece cost together, with what the walls between them hide.
auto Work::cost_instead(const Piece& whole, const std::vector<Piece>& pieces) const -> double {
  std::vector<const Piece*> each;
  for (const auto& one : pieces) each.push_back(&one);
  double cost = options_.part_price * (static_cast<double>(pieces.size()) - 1) + hidden(whole.site, whole.roof, each);
  for (const auto& one : pieces) cost += one.roof.cost;
  return cost;
}

/// The cuts between wings, those with most misfit about them.
auto Work::wings_of(const Piece& piece, double least_gain) const -> std::vector<Proposal> {
  struct Promising {
    WingLine line;
    double about = 0;  // m²·m²
  };
  std::vector<Promising> lines;
  for (auto& line : wing_lines_of(piece.site.polygon, options_)) {
    const double about = misfit_about(piece, line.middle(), line.length());
    if (about >= least_gain) lines.push_back({std::move(line), about});
  }
  rank(
      lines, [](const Promising& one) { return -one.about; }, options_.same_cost);
  const auto most = static_cast<std::size_t>(options_.wings.max_cuts);
  std::vector<Proposal> wings;
  if (lines.empty()) return wings;
  Heights model = piece.site.measured;
  model.z = piece.roof.view.z;
  const Gains gains(piece.site.polygon, piece.site.measured, model, options_);
  for (const auto& [line, about] : lines) {
    if (wings.size() >= most) break;
    for (auto& wing : wings_along(piece.site.polygon, line, options_)) {
      const double gain = gains.of(wing, line.along);
      if (gain >= explained_of_wing * least_gain) wings.push_back({std::move(wing), gain, "a wing", true});
    }
  }
  if (wings.size() > most) wings.resize(most);
  return wings;
}

/// m²·m²: of samples that count less beside the walls between some pieces, what no roof explains: neither that of the
/// whole, nor their own, nor those beside them. Else a wall through what no roof explains would pay by hiding it.
auto Work::hidden(const Site& whole, const Judged& roof, std::span<const Piece* const> pieces) const -> double {
  double sum = 0;
  for (const Piece* piece : pieces) {
    const Site& site = piece->site;
    for (std::size_t i = 0; i < site.cells.size(); ++i) {
      if (site.weight[i] == 1) continue;
      const Point2 place = site.places[i];
      if (geometry::boundary_distance(whole.polygon, place) < options_.margin) continue;
      double off = std::numeric_limits<double>::infinity();
      const auto compare = [&](double height) {
        if (!std::isnan(height)) off = std::min(off, std::abs(height - site.z[i]));
      };
      compare(piece->roof.view.z_of(site, i));
      compare(z_beside(roof, whole, place) - site.base);
      for (const Piece* other : pieces)
        if (other != piece) compare(z_beside(other->roof, other->site, place) - site.base);
      if (std::isinf(off)) continue;
      const double left = site.of_points ? stray_loss(off, options_.samples.stray) : loss(off, options_.robust);
      sum += (1 - site.weight[i]) * left * site.sample_area;
    }
  }
  return sum;
}

/// m²·m²: squared differences of the looks around a place.
auto Work::misfit_about(const Piece& piece, geometry::Point2 place, double within) const -> double {
  const auto& site = piece.site;
  double sum = 0;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto off = site.places[i] - place;
    const double d = std::abs(piece.roof.view.z_of(site, i) - site.z[i]);
    if (dot(off, off) < within * within && !std::isnan(d)) sum += site.weight[i] * d * std::min(d, options_.robust);
  }
  return sum * site.sample_area;
}

/// Both under one roof, where their grounds make one polygon.
auto Work::united(const Piece& a, const Piece& b) const -> std::optional<Union> {
  auto polygon = joined(a.site.polygon, b.site.polygon, options_);
  if (!polygon) return std::nullopt;
  Site site = both_of(a, b, *polygon);
  const Origin origins[]{{a.draft, a.roof.plan}, {b.draft, b.roof.plan}};
  Draft draft = draft_of(origins, site, options_);
  auto made =
      roofed(std::min(a.draft_index, b.draft_index), std::move(site), std::move(draft), Search::quick, cost_of(a, b));
  if (!made) return std::nullopt;
  return Union{std::move(*polygon), std::move(made->draft), std::move(made->roof), std::move(made->known)};
}

/// The same where that is cheaper.
auto Work::as_one(const Piece& a, const Piece& b, const Union& both) const -> std::optional<Piece> {
  const double worth = cost_of(a, b);
  if (!cheaper(both.roof.cost, worth, options_.same_cost)) return std::nullopt;
  auto made = roofed(std::min(a.draft_index, b.draft_index), both_of(a, b, both.polygon), both.draft, Search::thorough,
                     worth, both.known, &both.roof);
  if (!made || !cheaper(made->roof.cost, worth, options_.same_cost)) return std::nullopt;
  made->changes.insert(made->changes.begin(), "parts of " + square_metres(a) + " and " + square_metres(b) +
                                                  " joined under one roof, at a cost of " +
                                                  base::to_text(made->roof.cost, 1) + " instead of " +
                                                  base::to_text(worth, 1));
  return std::move(*made);
}

/// m²·m²: of the squared differences that are not noise, those along the other's ground.
auto Work::misfit_near(const Piece& piece, const geometry::Polygon& other) const -> double {
  const auto& site = piece.site;
  const Judge judge = judge_of(site);
  double sum = 0;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const double d = std::abs(piece.roof.view.z_of(site, i) - site.z[i]);
    if (!(d > options_.lines.robust)) continue;
    if (geometry::boundary_distance(other, site.places[i]) < options_.joins.recut_reach)
      sum += site.of_points ? judge.reducible_at(piece.roof, i) : d * std::min(d, options_.robust);
  }
  return sum * site.sample_area;
}

/// Whether two that touch may be cheaper as one: two flat roofs too far apart are not.
auto Work::may_join(const Piece& a, const Piece& b) const -> bool {
  const auto level = [](const Piece& piece) -> std::optional<double> {
    for (const auto& profile : piece.roof.plan.profiles)
      if (profile.back().inward > 0) return std::nullopt;
    return piece.roof.plan.cap;
  };
  if (a.site.cells.empty() || b.site.cells.empty()) return true;
  const auto low = level(a), high = level(b);
  if (!low || !high) return true;
  const double area = std::min(geometry::area(a.site.polygon), geometry::area(b.site.polygon));
  const double step = std::abs(*high - *low);
  const double saved = options_.part_price + static_cast<double>(options_.joins.shared_faces) * options_.face_price +
                       a.roof.unsupported + b.roof.unsupported;
  return area * std::min(step * step, options_.robust * step) < saved;
}

/// m²·m²: what the faces cost that no roof over the polygon can do without: its walls, its floor and one roof plane.
auto Work::cost_of_faces(const geometry::Polygon& polygon) const -> double {
  std::size_t faces = polygon.outer.size() + 2;
  for (const auto& hole : polygon.holes) faces += hole.size();
  return options_.face_price * static_cast<double>(faces);
}

/// The pieces of a cut, each with a roof found quickly; none where they cost more than they are worth.
auto Work::tried(const Piece& piece, const Proposal& proposal, double worth) const -> std::vector<Piece> {
  std::vector<Piece> out;
  double left = worth;
  const Origin origin[]{{piece.draft, piece.roof.plan}};
  const double narrowest = proposal.rim ? options_.bends.min_depth : options_.pieces.min_width;
  const auto polygons = cut(piece.site.polygon, proposal.polygon, options_, narrowest);
  double fewest = options_.part_price * (static_cast<double>(polygons.size()) - 1);
  for (const auto& polygon : polygons) fewest += cost_of_faces(polygon);
  if (fewest >= worth) return {};
  for (const auto& polygon : polygons) {
    Site site = without_remnants(with_ceilings(crop(piece.site, polygon, options_)));
    const auto too_high = too_high_over(site, piece.site.measured, piece.roof.view.z);
    if (site.cells.empty() && too_high == 0) return {};
    const double known = site.seen_area() + site.cell_area * static_cast<double>(too_high);
    if (known < options_.pieces.seen_share * geometry::area(polygon)) return {};
    Draft draft = draft_of(origin, site, options_);
    const bool rest = out.empty() && !proposal.whole_side;  // its roof was found before; a little of it is gone
    const Search search = rest ? Search::settled : Search::quick;
    auto made = roofed(piece.draft_index, std::move(site), std::move(draft), search, left);
    if (!made) return {};
    if ((!out.empty() || proposal.rim) && !proposal.whole_side && !is_of_roof(*made, options_)) return {};
    left -= made->roof.cost + (out.empty() ? 0 : options_.part_price);
    fewest -= cost_of_faces(polygon) + (out.empty() ? 0 : options_.part_price);
    if (left - fewest <= options_.same_cost) return {};
    out.push_back(std::move(*made));
  }
  return out;
}

/// A roof as it is seen over another site of the same grid: with or without the samples of what stands on it.
auto seen_over(const Judged& roof, const Site& site) -> Judged {
  Judged out = roof;
  if (site.of_points) out.view = view_of(roof.sketch, site);
  return out;
}

/// The roof was fitted to what stands on it, too: looked for again without that, until roof and dormers together cost
/// no less. None where nothing stands on it, or that costs more than `most`.
auto Work::beside_dormers(const Piece& piece, double most) const -> std::optional<Piece> {
  struct Found {
    Judged roof;
    Site without;
    double cost = std::numeric_limits<double>::infinity();
  };
  const Site& all = piece.site;
  std::optional<Found> best;
  bool better = false;
  const auto consider = [&](base::Result<Judged> roof, const Site& without) {
    if (!roof) return;
    const auto [dormers, cost] = dormers_of(*roof, all);
    if (dormers.empty() || (best && !cheaper(cost, best->cost, options_.same_cost)) || !is_sound(raised(roof->plan)))
      return;
    better = better || !best || cost < best->cost - options_.dormers.price;
    best = Found{std::move(*roof), without, cost};
  };
  const auto try_beside_dormers_of = [&](const Judged& roof, bool thorough) {
    const auto dormers = dormers_on(seen_over(roof, all), all, options_, Where::anywhere);
    if (dormers.empty()) return;
    const Site without = detail::without_dormers(all, dormers, options_.samples.melt, options_);
    if (without.cells.empty()) return;
    const Judge judge = judge_of(without);
    consider(judge(refitted(seen_over(roof, without), without, options_)), without);
    if (!thorough) return;
    if (auto again = roofed(piece.draft_index, without, piece.draft)) consider(std::move(again->roof), without);
  };
  try_beside_dormers_of(piece.roof, true);
  constexpr int rounds = 3;  // a better roof shows more of them
  for (int round = 0; round < rounds && best && std::exchange(better, false); ++round) {
    const Judged roof = best->roof;
    try_beside_dormers_of(roof, false);
  }
  if (!best || !cheaper(best->cost, most, options_.same_cost)) return std::nullopt;
  auto sharp = sharpened(best->roof, judge_of(best->without));
  if (sharp.plan != best->roof.plan)
    if (const auto [dormers, cost] = dormers_of(sharp, all);
        !dormers.empty() && cost <= best->cost + options_.face_price && cheaper(cost, most, options_.same_cost) &&
        is_sound(raised(sharp.plan)))
      best->roof = std::move(sharp);
  Piece out = piece;
  out.roof = std::move(best->roof);
  out.whole = std::move(out.site);
  out.site = std::move(best->without);
  return out;
}

/// The dormers that can be built on a roof and are worth it, and what roof and dormers cost together on all of the
/// ground, m²·m².
auto Work::dormers_of(const Judged& roof, const Site& all) const -> std::pair<std::vector<Dormer>, double> {
  const Judge judge = judge_of(all);
  const Judged over = seen_over(roof, all);
  View view = over.view;
  double misfit = judge.misfit_of(view);
  std::vector<Dormer> out;
  for (auto& dormer : dormers_on(over, all, options_)) {
    View with = view;
    paint(dormer, all, with);
    const double then = judge.misfit_of(with);
    if (!cheaper(then, misfit, options_.same_cost)) continue;
    view = std::move(with);
    misfit = then;
    out.push_back(std::move(dormer));
  }
  return {std::move(out), roof.cost - roof.misfit + misfit};
}

auto Work::finished(Piece piece) const -> Piece {
  if (piece.site.cells.empty() && !piece.site.ceilings.empty())
    piece.changes.push_back("the crown of a tree hides it: its height, " + base::to_text(piece.roof.plan.cap, 1) +
                            " m, is a guess");
  const bool keep = options_.effort == Effort::caps || piece.site.cells.empty() ||
                    judge_of(piece.site).wrong(piece.roof) < options_.face_price || run_.cancelled();
  if (keep) return piece;
  const auto in_full = [&](const Judged& roof) -> std::optional<extrude::Raised> {
    auto raised = extrude::raise(roof.plan, raising_, run_);
    if (!raised || raised->outcome != extrude::Outcome::full) return std::nullopt;
    return std::move(*raised);
  };
  auto sharp = sharpened(piece.roof, judge_of(piece.site));
  // A scan melts dormers: what is as good to within that is said with them, as when planes are sharpened.
  const double most = sharp.cost + options_.face_price;
  std::optional<Piece> beside;
  if (options_.effort == Effort::parts && options_.dormers.price > 0 && piece.roof.misfit >= options_.dormers.price)
    beside = beside_dormers(piece, most);
  if (sharp.plan != piece.roof.plan)
    if (auto raised = in_full(sharp)) {
      piece.roof = std::move(sharp);
      piece.raised = std::move(*raised);
    }
  if (!beside) return piece;
  auto raised = in_full(beside->roof);
  if (!raised) return piece;
  beside->raised = std::move(*raised);
  beside->plain = std::make_shared<Piece>(std::move(piece));
  return std::move(*beside);
}

auto Work::with_dormers(Piece piece) const -> std::vector<Piece> {
  std::vector<Piece> out;
  if (piece.whole && !run_.cancelled()) {
    for (const auto& dormer : dormers_of(piece.roof, *piece.whole).first) {
      auto holed = with_hole(piece.roof.plan, dormer);
      auto host = raised(holed), own = raised(dormer.plan);
      if (!is_sound(host) || !is_sound(own)) continue;
      piece.roof.plan = std::move(holed);
      piece.raised = std::move(*host);
      Piece part{piece.draft_index, {}, {}, {}, std::move(*own), {"a part of its own: a dormer"}};
      part.roof.plan = dormer.plan;
      out.push_back(std::move(part));
    }
    // A copy first: assigning to a piece lets go of its plain one, member by member.
    if (out.empty()) piece = Piece(*piece.plain);
  }
  out.insert(out.begin(), std::move(piece));
  return out;
}

auto Work::with_roof(const Piece& piece, const model::Plan& plan, double most) const -> std::optional<Piece> {
  auto judged = judge_of(piece.site)(plan);
  if (!judged || judged->cost > most) return std::nullopt;
  auto raised = this->raised(plan);
  if (!raised || raised->outcome != extrude::Outcome::full) return std::nullopt;
  Piece out = piece;
  out.roof = std::move(*judged);
  out.raised = std::move(*raised);
  return out;
}

/// The same pieces searched thoroughly; none where a sketch is one that no solid can be made of.
auto Work::searched(const Piece& piece, const Proposal& proposal, std::vector<Piece> pieces) const
    -> std::vector<Piece> {
  double cost = options_.part_price * (static_cast<double>(pieces.size()) - 1);
  for (const auto& one : pieces) cost += one.roof.cost;
  const auto before_and_after =
      ", at a cost of at most " + base::to_text(cost, 1) + " instead of " + base::to_text(piece.roof.cost, 1);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Judged found = std::move(pieces[i].roof);
    auto better = roofed(piece.draft_index, std::move(pieces[i].site), std::move(pieces[i].draft), Search::thorough,
                         std::numeric_limits<double>::infinity(), std::move(pieces[i].known), &found);
    if (!better) return {};
    pieces[i] = std::move(*better);
    auto& changes = pieces[i].changes;
    if (i == 0) changes.insert(changes.begin(), piece.changes.begin(), piece.changes.end());
    else
      changes.insert(changes.begin(),
                     "a part of its own of " + square_metres(pieces[i]) + ": " + proposal.what + before_and_after);
  }
  return pieces;
}

}  // namespace mansard::refine::detail
