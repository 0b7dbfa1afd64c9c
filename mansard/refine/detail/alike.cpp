#include "mansard/refine/detail/alike.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/text.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/refit.hpp"
#include "mansard/refine/detail/ties.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;

/// m: parts whose outlines run along each other for less are no neighbours, as evaluate has it (docs/evaluate.md,
/// Form), and shorter ridges are not compared.
constexpr double touching_length = 1;
/// m and rad: how near two heights and two pitches are that a person would take for one, as evaluate has it (near
/// ridges and twins there). A small face says little about its pitch, so that the price alone would let it turn by tens
/// of degrees.
constexpr double near_height = 0.3;
constexpr double near_pitch = 3 * std::numbers::pi / 180;

/// A plane of a roof as its edge sees it: two values, its height at the edge (z, m) and its slope; a level one has the
/// first alone.
struct Line {
  std::size_t piece = 0;
  std::uint32_t profile = 0, part = 0;
  bool level = false;
  std::size_t kind = 0;  ///< lines of one kind are compared: first ones, or equally placed ones in equal profiles
  Point2 inward;         ///< unit, in plan
  std::array<double, 3> sums{};  ///< m², m³, m⁴: the ground of its samples, and times their distances
  bool free = false;             ///< never tied: its roof cannot stand otherwise
  std::size_t value = 0;
};

/// A level roof at the cap.
struct Cap {
  std::size_t piece = 0;
  double sum = 0;  ///< m²
  std::size_t value = 0;
};

/// Where two opposite planes of a part meet.
struct Ridge {
  std::size_t piece = 0;
  std::size_t a = 0, b = 0;  ///< lines
  double apart = 0;          ///< m between their edges
  double length = 0;         ///< m
};

/// Two values, or two ridges, that may be made equal.
struct Candidate {
  bool ridges = false;
  std::size_t a = 0, b = 0;  ///< values, or ridges
  std::size_t piece_a = 0, piece_b = 0;
  double price = 0;
  bool open = true, stale = true;
};

/// How far a piece may be tied.
enum class Reach : std::uint8_t { none, itself, neighbours };

class Alike {
 public:
  Alike(std::vector<Piece>& pieces, const Work& work) : pieces_(pieces), work_(work), options_(work.options()) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) collect(i);
    reach_.assign(pieces_.size(), Reach::neighbours);
    touching_ = touching_pairs();
  }

  void run() {
    std::vector<Piece> made;
    constexpr int rounds = 6;  // every round some piece reaches less far; after these, none of those that failed at all
    for (int round = 1; !work_.cancelled(); ++round) {
      solve();
      std::vector<std::optional<Piece>> found(pieces_.size());
      std::vector<char> failed(pieces_.size(), 0);
      base::parallel_for(pieces_.size(), [&](std::size_t i) {
        if (reach_[i] == Reach::none || ties_of_[i] == 0) return;
        auto plan = plan_of(i);
        if (plan && *plan == pieces_[i].roof.plan) return;
        if (plan) found[i] = work_.with_roof(pieces_[i], *plan, pieces_[i].roof.cost + allowed(i));
        failed[i] = found[i] ? 0 : 1;
      });
      if (std::ranges::none_of(failed, [](char f) { return f != 0; })) {
        for (std::size_t i = 0; i < pieces_.size(); ++i)
          if (found[i]) take(i, std::move(*found[i]));
        return;
      }
      std::vector<std::vector<std::uint32_t>> guilty(pieces_.size());
      base::parallel_for(pieces_.size(), [&](std::size_t i) {
        if (failed[i] != 0 && round < rounds) guilty[i] = guilty_of(i);
      });
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (failed[i] == 0) continue;
        for (const std::size_t l : lines_of_[i])
          lines_[l].free = lines_[l].free || std::ranges::find(guilty[i], lines_[l].profile) != guilty[i].end();
        if (guilty[i].empty())
          reach_[i] = reach_[i] == Reach::neighbours && round < rounds ? Reach::itself : Reach::none;
      }
    }
  }

 private:
  auto number_of(std::size_t piece, std::uint32_t profile, std::uint32_t part) const -> std::optional<std::size_t> {
    const auto at = numbers_.find({piece, profile, part});
    return at == numbers_.end() ? std::nullopt : std::optional(at->second);
  }

  /// The lines, caps and ridges of a piece, with the ground of what is seen of them.
  void collect(std::size_t p) {
    const Piece& piece = pieces_[p];
    const auto& [plan, sketch, view, misfit, bare, unsupported, cost] = piece.roof;
    const auto& site = piece.site;
    const auto sides = sides_of(plan);
    const auto edges = edges_of(plan);
    const std::size_t first = lines_.size();
    double cap = 0;
    for (std::size_t i = 0; i < site.cells.size(); ++i) {
      const double roof = view.z_of(site, i);
      if (std::isnan(roof)) continue;
      const auto& face = sketch.faces[view.face_of(site, i)];
      const double off = std::abs(site.z[i] - roof);
      const double weight =
          site.weight[i] * site.sample_area * (off <= options_.lines.robust ? 1 : options_.lines.robust / off);
      if (face.kind == model::FaceKind::cap) cap += weight;
      if (!face.provenance || face.kind == model::FaceKind::connector) continue;
      const Edge& edge = edges[face.provenance->ring][face.provenance->edge];
      const auto profile = edge.profile, part = face.provenance->part;
      // A roof from the ground up has its foot there; what is past the profile's end goes on as its last part.
      if (part == 0 || part + 1 >= plan.profiles[profile].size()) continue;
      const auto line = line_of(plan.profiles[profile], part);
      if (!line) continue;
      const auto [at, fresh] = numbers_.try_emplace({p, profile, part}, lines_.size());
      if (fresh)
        lines_.push_back({p,
                          profile,
                          part,
                          line->slope == 0,
                          kind_of(plan.profiles[profile], part),
                          sides[profile].inward,
                          {},
                          false,
                          0});
      const double d = edge.to(site.places[i]);
      const double within = site.of_points ? 0 : site.cell_area / 12;  // of a cell about its centre
      auto& sums = lines_[at->second].sums;
      sums[0] += weight, sums[1] += weight * d, sums[2] += weight * (d * d + within);
    }
    if (cap >= static_cast<double>(options_.refit.min_cap_samples) * site.sample_area) caps_.push_back({p, cap, 0});
    if (lines_.size() > first) collect_ridges(p, edges);
  }

  static auto kind_of(const model::Profile& profile, std::uint32_t part) -> std::size_t {
    const bool level = profile[part].height == profile[part + 1].height;
    return 2 * (profile[part].inward == 0 ? 0 : profile.size() * 64 + part) + (level ? 1 : 0);
  }

  void collect_ridges(std::size_t p, const std::vector<std::vector<Edge>>& edges) {
    const auto& [plan, sketch, view, misfit, bare, unsupported, cost] = pieces_[p].roof;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> faces;  // by the edge they walk
    std::map<std::pair<std::size_t, std::size_t>, Ridge> longest;
    const auto edge_of = [&](const model::Face& face) -> const Edge& {
      return edges[face.provenance->ring][face.provenance->edge];
    };
    const auto line_of_face = [&](const model::Face& face) -> std::optional<std::size_t> {
      if (!face.provenance || face.kind != model::FaceKind::side) return std::nullopt;
      return number_of(p, edge_of(face).profile, face.provenance->part);
    };
    for (std::uint32_t f = 0; f < sketch.faces.size(); ++f)
      for (const auto& loop : sketch.faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) faces[{loop[i], loop[(i + 1) % loop.size()]}] = f;
    for (const auto& [edge, f] : faces) {
      const auto twin = faces.find({edge.second, edge.first});
      if (twin == faces.end() || twin->second <= f) continue;
      const auto &left = sketch.faces[f], &right = sketch.faces[twin->second];
      const auto a = line_of_face(left), b = line_of_face(right);
      if (!a || !b || *a == *b || lines_[*a].level || lines_[*b].level) continue;
      const Point2 u = geometry::normalised(xy(left.normal)), v = geometry::normalised(xy(right.normal));
      if (dot(u, v) > -options_.search.opposite_cosine) continue;
      const auto from = sketch.vertices[edge.first], to = sketch.vertices[edge.second];
      const double length = geometry::length(xy(to) - xy(from));
      const Point2 middle = 0.5 * (xy(from) + xy(to));
      auto& ridge = longest[std::minmax(*a, *b)];
      if (length <= ridge.length) continue;
      ridge = {p, *a, *b, edge_of(left).to(middle) + edge_of(right).to(middle), length};
    }
    for (const auto& [pair, ridge] : longest)
      if (ridge.length >= touching_length) ridges_.push_back(ridge);
  }

  /// m of a's boundary that the other's runs along.
  [[nodiscard]] auto shared(const Piece& a, const Piece& b) const -> double {
    const auto near = geometry::bounds(b.site.polygon.outer).grown(options_.joins.touching);
    double sum = 0;
    const auto walk = [&](const geometry::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 from = ring[i], along = ring[(i + 1) % ring.size()] - from;
        if (!near.overlaps(geometry::Box2::of(geometry::Segment2{from, from + along}))) continue;
        const auto n = static_cast<std::size_t>(std::ceil(geometry::length(along) / options_.grid));
        for (std::size_t k = 0; k < n; ++k) {
          const Point2 at = from + ((static_cast<double>(k) + 0.5) / static_cast<double>(n)) * along;
          if (geometry::boundary_distance(b.site.polygon, at) <= options_.joins.touching)
            sum += geometry::length(along) / static_cast<double>(n);
        }
      }
    };
    walk(a.site.polygon.outer);
    for (const auto& hole : a.site.polygon.holes) walk(hole);
    return sum;
  }

  [[nodiscard]] auto touching_pairs() const -> std::vector<std::pair<std::size_t, std::size_t>> {
    std::vector<std::vector<std::size_t>> of(pieces_.size());
    base::parallel_for(pieces_.size(), [&](std::size_t i) {
      for (std::size_t j = i + 1; j < pieces_.size(); ++j)
        if (work_.touch(pieces_[i], pieces_[j]) && shared(pieces_[i], pieces_[j]) >= touching_length)
          of[i].push_back(j);
    });
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t i = 0; i < of.size(); ++i)
      for (const std::size_t j : of[i]) out.emplace_back(i, j);
    return out;
  }

  auto start() -> Values {
    Values values;
    for (auto& line : lines_) {
      const auto& piece = pieces_[line.piece];
      const auto own = *line_of(piece.roof.plan.profiles[line.profile], line.part);
      const double z = piece.site.base + own.at_edge;
      auto sums = line.sums;
      const double counts = told_by(sums[0]);
      for (double& sum : sums) sum *= counts;
      line.value = line.level ? values.add(z, sums[0]) : values.add(z, own.slope, sums);
    }
    for (auto& cap : caps_)
      cap.value =
          values.add(pieces_[cap.piece].site.base + pieces_[cap.piece].roof.plan.cap, told_by(cap.sum) * cap.sum);
    return values;
  }

  /// How much of some ground, m², counts for a height that has a bias: two heights are alike where they differ by less
  /// than the root of price / ground, or by less than the bias.
  [[nodiscard]] auto told_by(double ground) const -> double {
    const double bias = options_.alike.bias, price = options_.value_price;
    return price > 0 ? 1 / (1 + ground * bias * bias / price) : 1;
  }

  /// m: the height of a ridge, and what of it each of four values makes.
  struct Height {
    double z = 0;
    std::array<double, 4> by{};
    std::array<std::size_t, 4> value{};
  };
  [[nodiscard]] auto height_of(const Ridge& ridge, const Values& values) const -> Height {
    const std::size_t a = lines_[ridge.a].value, b = lines_[ridge.b].value;
    const double za = values[a], sa = values[a + 1], zb = values[b], sb = values[b + 1], w = ridge.apart, s = sa + sb;
    const double from_a = (zb - za + sb * w) / s, from_b = (za - zb + sa * w) / s;  // m inward of either edge
    return {za + sa * from_a, {sb / s, sb / s * from_a, sa / s, sa / s * from_b}, {a, a + 1, b, b + 1}};
  }

  /// Ridges are where planes meet: their heights are taken as linear in the values about what those are.
  [[nodiscard]] auto tie_of(const Candidate& one, const Values& values) const -> Tie {
    if (!one.ridges) return {{{one.a, 1}, {one.b, -1}}, 0};
    const auto a = height_of(ridges_[one.a], values), b = height_of(ridges_[one.b], values);
    Tie tie;
    tie.level = b.z - a.z;
    for (const auto& [height, sign] : {std::pair{&a, 1.0}, std::pair{&b, -1.0}})
      for (std::size_t k = 0; k < 4; ++k) {
        tie.terms.push_back({height->value[k], sign * height->by[k]});
        tie.level += sign * height->by[k] * values[height->value[k]];
      }
    return tie;
  }

  [[nodiscard]] auto near(const Ridge& a, const Ridge& b) const -> bool {
    for (const std::size_t line : {a.a, a.b, b.a, b.b})
      if (lines_[line].free) return false;
    return std::abs(height_of(a, start_).z - height_of(b, start_).z) <= near_height;
  }
  /// rad between two slopes.
  static auto turn(double a, double b) -> double {
    return std::abs(geometry::arc_tangent(a, 1) - geometry::arc_tangent(b, 1));
  }

  using Candidates = std::vector<Candidate>;

  void add_lines(std::size_t piece_a, std::size_t piece_b, bool slopes, Candidates& out) const {
    const bool same = piece_a == piece_b, owner = pieces_[piece_a].draft.owner == pieces_[piece_b].draft.owner;
    for (const std::size_t i : lines_of_[piece_a])
      for (const std::size_t j : lines_of_[piece_b]) {
        if (same && j <= i) continue;
        const Line &a = lines_[i], &b = lines_[j];
        if (a.kind != b.kind || a.free || b.free) continue;
        // Of another building what is on the same side of the row.
        if (!owner && dot(a.inward, b.inward) < options_.search.opposite_cosine) continue;
        if (!slopes && std::abs(start_[a.value] - start_[b.value]) <= near_height)
          out.push_back({false, a.value, b.value, piece_a, piece_b});
        if (slopes && !a.level && turn(start_[a.value + 1], start_[b.value + 1]) <= near_pitch)
          out.push_back({false, a.value + 1, b.value + 1, piece_a, piece_b});
      }
  }

  [[nodiscard]] auto within_parts() const -> Candidates {
    Candidates out;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (reach_[p] == Reach::none) continue;
      add_lines(p, p, false, out);
      add_lines(p, p, true, out);
      for (std::size_t i = 0; i < ridges_of_[p].size(); ++i)
        for (std::size_t j = i + 1; j < ridges_of_[p].size(); ++j)
          if (near(ridges_[ridges_of_[p][i]], ridges_[ridges_of_[p][j]]))
            out.push_back({true, ridges_of_[p][i], ridges_of_[p][j], p, p});
    }
    return out;
  }
  [[nodiscard]] auto between_parts(bool slopes) const -> Candidates {
    Candidates out;
    for (const auto& [p, q] : touching_) {
      if (reach_[p] != Reach::neighbours || reach_[q] != Reach::neighbours) continue;
      add_lines(p, q, slopes, out);
      if (slopes) continue;
      for (const std::size_t i : caps_of_[p])
        for (const std::size_t j : caps_of_[q])
          if (std::abs(start_[caps_[i].value] - start_[caps_[j].value]) <= near_height)
            out.push_back({false, caps_[i].value, caps_[j].value, p, q});
      for (const std::size_t i : ridges_of_[p])
        for (const std::size_t j : ridges_of_[q])
          if (near(ridges_[i], ridges_[j])) out.push_back({true, i, j, p, q});
    }
    return out;
  }

  [[nodiscard]] auto values_of(const Candidate& one) const -> std::vector<std::size_t> {
    if (!one.ridges) return {one.a, one.b};
    std::vector<std::size_t> out;
    for (const std::size_t r : {one.a, one.b})
      for (const std::size_t l : {ridges_[r].a, ridges_[r].b}) out.push_back(lines_[l].value);
    return out;
  }

  /// The cheapest first, until none is cheaper than what it saves.
  void tie_all(Candidates candidates, Values& values, Candidates& taken) const {
    for (;;) {
      double least = std::numeric_limits<double>::infinity();
      for (auto& one : candidates) {
        if (!one.open) continue;
        if (std::exchange(one.stale, false)) one.price = values.price(tie_of(one, values));
        least = std::min(least, one.price);
      }
      if (!cheaper(least, options_.value_price, options_.same_cost)) return;
      const auto best = std::ranges::find_if(
          candidates, [&](const Candidate& one) { return one.open && one.price <= least + options_.same_cost; });
      best->open = false;
      taken.push_back(*best);
      values.hold(tie_of(*best, values));
      const auto group = values.group(values_of(*best).front());
      for (auto& one : candidates)
        one.stale =
            one.stale ||
            (one.open && std::ranges::any_of(values_of(one), [&](std::size_t v) { return values.group(v) == group; }));
    }
  }

  void solve() {
    start_ = start();
    Values values = start_;
    lines_of_.assign(pieces_.size(), {});
    caps_of_ = ridges_of_ = lines_of_;
    for (std::size_t i = 0; i < lines_.size(); ++i) lines_of_[lines_[i].piece].push_back(i);
    for (std::size_t i = 0; i < caps_.size(); ++i) caps_of_[caps_[i].piece].push_back(i);
    for (std::size_t i = 0; i < ridges_.size(); ++i) ridges_of_[ridges_[i].piece].push_back(i);
    Candidates taken;
    tie_all(within_parts(), values, taken);
    tie_all(between_parts(false), values, taken);
    tie_all(between_parts(true), values, taken);
    for (int round = 0; round < 2; ++round) {  // ridges as they are at the end, not as they were when they were tied
      Values again = start_;
      for (const auto& one : taken) again.hold(tie_of(one, values));
      values = std::move(again);
    }
    at_.resize(values.size());
    for (std::size_t v = 0; v < values.size(); ++v) at_[v] = values[v];
    base::DisjointSets same(values.size());  // what was tied one to one is one number, to the last digit
    ties_of_.assign(pieces_.size(), 0);
    near_.assign(pieces_.size(), false);
    for (const auto& one : taken) {
      if (one.price > 0) {
        ++ties_of_[one.piece_a];
        if (one.piece_b != one.piece_a) ++ties_of_[one.piece_b];
      }
      if (one.piece_b != one.piece_a) near_[one.piece_a] = near_[one.piece_b] = true;
      if (one.ridges) continue;
      same.join(static_cast<std::uint32_t>(one.a), static_cast<std::uint32_t>(one.b));
    }
    for (std::size_t v = 0; v < values.size(); ++v) at_[v] = at_[same.of(static_cast<std::uint32_t>(v))];
  }

  /// The piece's plan with its values as they are tied; of one profile alone, or of all of them and the cap.
  [[nodiscard]] auto plan_of(std::size_t p, std::optional<std::uint32_t> only = std::nullopt) const
      -> std::optional<Plan> {
    Plan plan = pieces_[p].roof.plan;
    const double base = pieces_[p].site.base;
    std::map<std::uint32_t, std::vector<std::optional<RoofLine>>> moved;
    for (const std::size_t i : lines_of_[p]) {
      const Line& line = lines_[i];
      if (only.value_or(line.profile) != line.profile || !has_moved(line)) continue;
      const auto& profile = plan.profiles[line.profile];
      auto& all = moved[line.profile];
      if (all.empty())
        for (std::size_t k = 0; k + 1 < profile.size(); ++k) all.push_back(line_of(profile, k));
      all[line.part] = RoofLine{at_[line.value] - base, line.level ? 0 : at_[line.value + 1]};
    }
    for (const auto& [profile, all] : moved) {
      auto next = chained(plan.profiles[profile], all);
      if (!next) return std::nullopt;
      plan.profiles[profile] = std::move(*next);
    }
    if (only) return plan;
    for (const std::size_t i : caps_of_[p])
      if (at_[caps_[i].value] != start_[caps_[i].value]) plan.cap = at_[caps_[i].value] - base;
    if (!(plan.cap > 0)) return std::nullopt;
    return plan;
  }
  [[nodiscard]] auto has_moved(const Line& line) const -> bool {
    return at_[line.value] != start_[line.value] || (!line.level && at_[line.value + 1] != start_[line.value + 1]);
  }

  /// The profiles whose change alone costs more than it may.
  [[nodiscard]] auto guilty_of(std::size_t p) const -> std::vector<std::uint32_t> {
    std::vector<std::uint32_t> out;
    for (std::uint32_t profile = 0; profile < pieces_[p].roof.plan.profiles.size(); ++profile) {
      const auto plan = plan_of(p, profile);
      if (plan && *plan == pieces_[p].roof.plan) continue;
      if (!plan || !work_.with_roof(pieces_[p], *plan, pieces_[p].roof.cost + allowed(p, profile)))
        out.push_back(profile);
    }
    return out;
  }

  /// m²·m²: what the piece's roof was thought to move by, and what is saved.
  [[nodiscard]] auto allowed(std::size_t p, std::optional<std::uint32_t> only = std::nullopt) const -> double {
    double sum = options_.value_price * static_cast<double>(ties_of_[p]);
    const auto& piece = pieces_[p];
    for (const std::size_t i : lines_of_[p]) {
      const Line& line = lines_[i];
      if (only.value_or(line.profile) != line.profile) continue;
      const auto own = *line_of(piece.roof.plan.profiles[line.profile], line.part);
      const double dz = at_[line.value] - piece.site.base - own.at_edge;
      const double ds = line.level ? 0 : at_[line.value + 1] - own.slope;
      sum += line.sums[0] * dz * dz + 2 * line.sums[1] * dz * ds + line.sums[2] * ds * ds;
    }
    if (only) return sum;
    for (const std::size_t i : caps_of_[p]) {
      const double dz = at_[caps_[i].value] - piece.site.base - piece.roof.plan.cap;
      sum += caps_[i].sum * dz * dz;
    }
    return sum;
  }

  /// What was done to the piece, by the side or level that moved most.
  [[nodiscard]] auto words(std::size_t p) const -> std::string {
    constexpr double degrees = 180 / std::numbers::pi;
    const auto& piece = pieces_[p];
    struct Move {
      double by = 0, from = 0, to = 0;
    };
    Move eave, pitch, level;
    const auto most = [](Move& of, double from, double to) {
      if (std::abs(to - from) > of.by) of = {std::abs(to - from), from, to};
    };
    for (const std::size_t i : lines_of_[p]) {
      const auto own = *line_of(piece.roof.plan.profiles[lines_[i].profile], lines_[i].part);
      const double height = at_[lines_[i].value] - piece.site.base;
      if (piece.roof.plan.profiles[lines_[i].profile][lines_[i].part].inward == 0) most(eave, own.at_edge, height);
      if (!lines_[i].level)
        most(pitch, degrees * geometry::arc_tangent(own.slope, 1),
             degrees * geometry::arc_tangent(at_[lines_[i].value + 1], 1));
    }
    for (const std::size_t i : caps_of_[p]) most(level, piece.roof.plan.cap, at_[caps_[i].value] - piece.site.base);
    std::string out;
    const auto add = [&out](const char* what, const Move& move, int decimals, const char* unit) {
      const auto from = base::to_text(move.from, decimals), to = base::to_text(move.to, decimals);
      if (from == to) return;
      out += (out.empty() ? "" : ", ") + std::string(what) + " " + from + " → " + to + unit;
    };
    add("gutter", eave, 2, " m");
    add("pitch", pitch, 1, "°");
    add("flat roof", level, 2, " m");
    if (out.empty()) return out;
    return out + (near_[p] ? " as its neighbours'" : " as its other sides'");
  }

  void take(std::size_t p, Piece made) {
    if (auto what = words(p); !what.empty()) made.changes.push_back(std::move(what));
    pieces_[p] = std::move(made);
  }

  std::vector<Piece>& pieces_;
  const Work& work_;
  const Options& options_;
  std::vector<Line> lines_;
  std::vector<Cap> caps_;
  std::vector<Ridge> ridges_;
  struct Key {
    std::size_t piece;
    std::uint32_t profile, part;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, std::size_t> numbers_;
  std::vector<std::vector<std::size_t>> lines_of_, caps_of_, ridges_of_;  // by piece
  std::vector<std::pair<std::size_t, std::size_t>> touching_;
  std::vector<Reach> reach_;
  Values start_;                      // as the scan alone has them
  std::vector<double> at_;            // m, and rise per run: the values as they are tied
  std::vector<std::size_t> ties_of_;  // by piece
  std::vector<bool> near_;            // by piece: whether any is with another
};

}  // namespace

void make_alike(std::vector<Piece>& pieces, const Work& work) {
  if (!pieces.empty() && work.options().value_price > 0 && !work.cancelled()) Alike(pieces, work).run();
}

}  // namespace mansard::refine::detail
