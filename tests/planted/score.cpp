#include "score.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace mansard::planted {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;
using geometry::Segment2;
using Polygons = std::vector<Polygon>;

constexpr double reach = 0.5;    ///< m; a wall found this far off is found
constexpr double spacing = 0.1;  ///< m between samples of a line

auto area(const Polygons& polygons) -> double {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

auto common_area(const Polygons& a, const Polygons& b) -> double {
  double sum = 0;
  for (const Polygon& p : a)
    for (const Polygon& q : b)
      if (geometry::bounds(p.outer).overlaps(geometry::bounds(q.outer))) sum += area(geometry::intersect(p, q).value());
  return sum;
}

/// Areas of two lists of things, and of what each of the one has in common with each of the other.
struct Overlaps {
  std::vector<double> planted, found;
  std::vector<std::vector<double>> common;
};
auto overlaps(const std::vector<Polygons>& planted, const std::vector<Polygons>& found) -> Overlaps {
  Overlaps o;
  for (const auto& p : planted) o.planted.push_back(area(p));
  for (const auto& f : found) o.found.push_back(area(f));
  for (const auto& p : planted) {
    o.common.emplace_back();
    for (const auto& f : found) o.common.back().push_back(common_area(p, f));
  }
  return o;
}

auto share(double part, double whole) -> double { return whole > 0 ? part / whole : 1; }

auto match(const Overlaps& o) -> Matching {
  double planted = 0, found = 0, planted_matched = 0, found_matched = 0;
  for (const double a : o.planted) planted += a;
  for (const double a : o.found) found += a;
  std::vector<bool> is_matched(o.found.size());
  for (std::size_t i = 0; i < o.planted.size(); ++i) {
    bool has_match = false;
    for (std::size_t j = 0; j < o.found.size(); ++j)
      if (o.common[i][j] > 0.5 * (o.planted[i] + o.found[j] - o.common[i][j])) has_match = is_matched[j] = true;
    if (has_match) planted_matched += o.planted[i];
  }
  for (std::size_t j = 0; j < o.found.size(); ++j)
    if (is_matched[j]) found_matched += o.found[j];
  return {share(planted_matched, planted), share(found_matched, found)};
}

auto count_splits(const Overlaps& o) -> std::size_t {
  std::size_t splits = 0;
  for (std::size_t i = 0; i < o.planted.size(); ++i) {
    int pieces = 0;
    for (std::size_t j = 0; j < o.found.size(); ++j)
      if (o.common[i][j] >= 0.1 * o.planted[i] && o.common[i][j] > 0.5 * o.found[j]) ++pieces;
    if (pieces >= 2) ++splits;
  }
  return splits;
}

auto count_merges(const Overlaps& o) -> std::size_t {
  std::size_t merges = 0;
  for (std::size_t j = 0; j < o.found.size(); ++j) {
    int held = 0;
    for (std::size_t i = 0; i < o.planted.size(); ++i)
      if (o.common[i][j] > 0.5 * o.planted[i]) ++held;
    if (held >= 2) ++merges;
  }
  return merges;
}

/// Pairs of places by area: sums of squares of the areas planted, found and common.
void score_pairs(const Overlaps& o, Score& score) {
  std::vector<double> covered(o.found.size());
  double all = 0, bare = 0, planted = 0, found = 0, common = 0;
  for (std::size_t i = 0; i < o.planted.size(); ++i) {
    double left = o.planted[i];
    for (std::size_t j = 0; j < o.found.size(); ++j) {
      covered[j] += o.common[i][j];
      common += o.common[i][j] * o.common[i][j];
      left -= o.common[i][j];
    }
    left = std::max(0.0, left);
    common += left * left;
    bare += left;
    planted += o.planted[i] * o.planted[i];
    all += o.planted[i];
  }
  found = bare * bare;
  for (const double a : covered) found += a * a;
  score.pair_recall = share(common, planted);
  score.pair_precision = share(common, found);
  score.rand = 1 - (all > 0 ? (planted + found - 2 * common) / (all * all) : 0);
}

/// A place on a line and the way the line runs there.
struct Sample {
  Point2 at, along;   ///< along of unit length
  double length = 0;  ///< m of line that it stands for
};
void sample(const Segment2& line, double weight, std::vector<Sample>& samples) {
  const Point2 whole = line.end - line.start;
  const double size = geometry::length(whole);
  const auto count = static_cast<int>(std::ceil(size / spacing));
  for (int k = 0; k < count; ++k)
    samples.push_back({line.start + ((k + 0.5) / count) * whole, geometry::normalised(whole), weight * size / count});
}

/// Samples by squares of the size of `reach`.
class Near {
 public:
  explicit Near(const std::vector<Sample>& samples) {
    for (const Sample& s : samples) squares_[square(s.at)].push_back(s);
  }
  /// Whether one is within reach, and runs the same way (within 30°) if that matters.
  [[nodiscard]] auto has(const Sample& of, bool same_way) const -> bool {
    const auto [x, y] = square(of.at);
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy) {
        const auto found = squares_.find({x + dx, y + dy});
        if (found == squares_.end()) continue;
        for (const Sample& s : found->second)
          if (geometry::length(s.at - of.at) <= reach &&
              (!same_way || std::abs(geometry::cross(s.along, of.along)) <= 0.5))
            return true;
      }
    return false;
  }

 private:
  [[nodiscard]] static auto square(Point2 p) -> std::pair<long, long> {
    return {std::lround(std::floor(p.x / reach)), std::lround(std::floor(p.y / reach))};
  }
  std::map<std::pair<long, long>, std::vector<Sample>> squares_;
};

/// Where one piece ends and another begins. Seen from both, so each counts half.
auto boundaries_between(const std::vector<Piece>& pieces) -> std::vector<Sample> {
  std::vector<Box2> boxes;
  for (const Piece& p : pieces) boxes.push_back(geometry::bounds(p.polygon.outer));
  const auto is_in_another = [&](std::size_t own, Point2 at) {
    for (std::size_t k = 0; k < pieces.size(); ++k)
      if (k != own && boxes[k].contains(at) && geometry::contains(pieces[k].polygon, at)) return true;
    return false;
  };
  std::vector<Sample> boundaries;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    std::vector<Sample> all;
    const auto add = [&](const geometry::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) sample({ring[i], ring[(i + 1) % ring.size()]}, 0.5, all);
    };
    add(pieces[k].polygon.outer);
    for (const auto& hole : pieces[k].polygon.holes) add(hole);
    for (const Sample& s : all)
      if (is_in_another(k, s.at - 0.1 * geometry::left_of(s.along))) boundaries.push_back(s);
  }
  return boundaries;
}

void score_walls(const Plan& truth, const Plan& found, Score& score) {
  std::vector<Sample> walls;
  for (const Segment2& w : truth.walls) sample(w, 1, walls);
  const auto boundaries = boundaries_between(found.pieces);
  const Near near_walls(walls), near_boundaries(boundaries);
  double recalled = 0, stray = 0;
  for (const Sample& s : walls) {
    score.wall_length += s.length;
    if (near_boundaries.has(s, true)) recalled += s.length;
  }
  for (const Sample& s : boundaries)
    if (!near_walls.has(s, false)) stray += s.length;
  score.wall_recall = share(recalled, score.wall_length);
  score.false_splits = score.wall_length > 0 ? stray / score.wall_length : stray;
}

auto one_by_one(const Plan& plan) -> std::vector<Polygons> {
  std::vector<Polygons> pieces;
  for (const Piece& p : plan.pieces) pieces.push_back({p.polygon});
  return pieces;
}

/// Pieces without a feature stay alone.
auto by_feature(const Plan& plan) -> std::vector<Polygons> {
  std::map<std::size_t, Polygons> features;
  std::vector<Polygons> all;
  for (const Piece& p : plan.pieces)
    if (p.feature) features[*p.feature].push_back(p.polygon);
    else all.push_back({p.polygon});
  for (auto& [feature, polygons] : features) all.push_back(std::move(polygons));
  return all;
}

}  // namespace

auto plan_of(const Block& planted) -> Plan {
  Plan plan;
  for (const House& h : planted.houses) plan.pieces.push_back({h.polygon, h.feature});
  for (const Wall& w : planted.walls) plan.walls.push_back(w.segment);
  return plan;
}

auto plan_of(const std::vector<segment::Part>& parts) -> Plan {
  Plan plan;
  for (const segment::Part& p : parts) plan.pieces.push_back({p.polygon, p.feature});
  return plan;
}

auto score(const Plan& truth, const Plan& found) -> Score {
  Score score;
  const Overlaps pieces = overlaps(one_by_one(truth), one_by_one(found));
  score.parts = match(pieces);
  score.features = match(overlaps(by_feature(truth), by_feature(found)));
  score.splits = count_splits(pieces);
  score.merges = count_merges(pieces);
  score_pairs(pieces, score);
  score_walls(truth, found, score);
  return score;
}

}  // namespace mansard::planted
