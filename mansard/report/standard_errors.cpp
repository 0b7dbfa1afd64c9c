#include "mansard/report/standard_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/solid/half_edges.hpp"
#include "mansard/solid/levels.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::report {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::FaceClass;

/// A variance, where it is known.
using Variance = std::optional<double>;

auto sum(Variance a, Variance b) -> Variance {
  if (!a || !b) return std::nullopt;
  return *a + *b;
}
auto times(double factor, Variance a) -> Variance {
  if (!a) return std::nullopt;
  return factor * *a;
}

/// z above and below a point: 1, x and y from a centre.
using Row = std::array<double, 3>;

/// A face of the roof, and how far the scan says it is off.
class RoofFace {
 public:
  RoofFace(const model::Solid& solid, std::size_t number, const Evidence& evidence)
      : normal_(solid.faces[number].normal) {
    const auto& face = solid.faces[number];
    corner_ = solid.vertices[face.loops.front().front()];
    lowest_ = highest_ = corner_.z;
    for (const auto v : face.loops.front()) {
      lowest_ = std::min(lowest_, solid.vertices[v].z), highest_ = std::max(highest_, solid.vertices[v].z);
    }
    area_ = solid::area(solid, face);
    sample(geometry::oriented(geometry::polygon_of(face.loops, [&](std::uint32_t v) { return xy(solid.vertices[v]); })),
           evidence);
  }

  [[nodiscard]] auto area() const -> double { return area_; }
  /// m², in plan.
  [[nodiscard]] auto ground() const -> double { return area_ * normal_.z; }
  [[nodiscard]] auto lowest() const -> double { return lowest_; }
  [[nodiscard]] auto highest() const -> double { return highest_; }
  [[nodiscard]] auto slope() const -> double { return std::hypot(normal_.x, normal_.y) / normal_.z; }
  [[nodiscard]] auto centre() const -> Point2 { return centre_; }
  [[nodiscard]] auto is_flat() const -> bool {
    constexpr double flat = 0.99996;  // cosine of 0.5°
    return normal_.z > flat;
  }
  /// m²: of the height at a point of it.
  [[nodiscard]] auto variance(Point2 at) const -> Variance {
    if (!seen_) return std::nullopt;
    const Point2 p = is_flat() ? Point2{} : at - centre_;  // a flat face is as high everywhere
    const double off = off_[0] + off_[1] * p.x + off_[2] * p.y;
    const double apart = (yy_ * p.x * p.x - 2 * xy_ * p.x * p.y + xx_ * p.y * p.y) / (xx_ * yy_ - xy_ * xy_);
    return off * off + chance_ / ground_ * (1 + apart);
  }

  /// z of its plane.
  [[nodiscard]] auto at(Point2 p) const -> double { return corner_.z - dot(xy(normal_), p - xy(corner_)) / normal_.z; }

 private:
  void sample(const geometry::Polygon& plan, const Evidence& evidence) {
    constexpr double most_samples = 2000, finest = 0.25;  // m; finer than the scans that are read
    const auto box = geometry::bounds(plan.outer);
    const auto& scan = evidence.accuracy;
    const double step = std::max(finest, std::sqrt(geometry::area(plan) / most_samples));
    // What is rounded along the boundary is left out, where anything is left of the face then.
    constexpr double far = 0.4;  // m; as in refine::decided_by
    const double rounded = std::min(far, 2.5 * scan.edge());
    for (const double margin : {rounded, rounded / 2, rounded / 4, 0.0}) {
      std::vector<Point3> samples;  // z: of the scan above the face
      for (double y = std::ceil(box.least.y / step) * step; y <= box.most.y; y += step)
        for (double x = std::ceil(box.least.x / step) * step; x <= box.most.x; x += step) {
          const Point2 p{x, y};
          if (!geometry::contains(plan, p) || geometry::boundary_distance(plan, p) < margin) continue;
          if (const auto z = evidence.mesh.top(p)) samples.push_back({x, y, *z - at(p)});
        }
      fit(samples, step * step, scan);
      if (seen_) return;
    }
  }

  /// The plane of the differences, by Huber's weights.
  void fit(const std::vector<Point3>& samples, double each, const model::Accuracy& scan) {
    constexpr std::size_t least = 4;
    if (samples.size() < least) return;
    constexpr double mad = 1.4826, huber = 1.345;  // P. Huber, Robust Statistics, 1981
    const double noise = scan.noise / normal_.z;
    std::vector<double> weights(samples.size(), 1), off;
    double scale = 0;
    for (int round = 0; round < 8; ++round) {
      double w = 0;
      centre_ = {};
      Row right{};
      for (std::size_t i = 0; i < samples.size(); ++i) centre_ = centre_ + weights[i] * xy(samples[i]), w += weights[i];
      centre_ = (1 / w) * centre_;
      xx_ = xy_ = yy_ = 0;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Point2 p = xy(samples[i]) - centre_;
        xx_ += weights[i] * p.x * p.x / w, xy_ += weights[i] * p.x * p.y / w, yy_ += weights[i] * p.y * p.y / w;
        right[0] += weights[i] * samples[i].z / w;
        right[1] += weights[i] * samples[i].z * p.x / w, right[2] += weights[i] * samples[i].z * p.y / w;
      }
      // One row of samples says nothing of what is beside it: it counts as as broad as a sample.
      xx_ += each / 12, yy_ += each / 12;
      const double determinant = xx_ * yy_ - xy_ * xy_;
      off_ = {right[0], (yy_ * right[1] - xy_ * right[2]) / determinant,
              (xx_ * right[2] - xy_ * right[1]) / determinant};
      if (is_flat()) off_[1] = off_[2] = 0;
      off.clear();
      const auto left = [&](const Point3& s) {
        return std::abs(s.z - off_[0] - off_[1] * (s.x - centre_.x) - off_[2] * (s.y - centre_.y));
      };
      for (const auto& s : samples) off.push_back(left(s));
      scale = std::max(1e-4, mad * base::median(off));
      for (std::size_t i = 0; i < samples.size(); ++i)
        weights[i] = std::min(1.0, huber * scale / std::max(1e-9, left(samples[i])));
    }
    const double ground = each * static_cast<double>(samples.size());
    // Noise that is correlated over several samples shows in each of them. The plane took that of three numbers off
    // what is left (docs/accuracy.md); where that is more than half, too few are left to tell.
    constexpr double several = 4, most_taken = 0.5;
    const double taken = 3 * scan.correlated_area / ground;
    const bool shows = scan.correlated_area > several * scan.spacing * scan.spacing && taken < most_taken;
    const double spread = shows ? scale / std::sqrt(1 - taken) : std::max(noise, scale);
    ground_ = ground;
    chance_ = std::min(spread * spread * scan.correlated_area, spread * spread * ground);
    seen_ = true;
    add_batches(samples, each, huber * scale);
  }

  /// Means of squares: of noise that is independent between batches, the mean square times their area is σ² A, whatever
  /// it is correlated over within one.
  void add_batches(const std::vector<Point3>& samples, double each, double most) {
    constexpr double along = 4, least = 1;  // batches along a side of the face; m
    const double side = std::max(least, std::sqrt(ground_) / along);
    std::map<std::pair<double, double>, std::pair<double, double>> batches;  // sum, number
    for (const auto& s : samples) {
      const double left = s.z - off_[0] - off_[1] * (s.x - centre_.x) - off_[2] * (s.y - centre_.y);
      auto& [all, number] = batches[{std::floor(s.x / side), std::floor(s.y / side)}];
      all += std::clamp(left, -most, most), ++number;
    }
    for (const auto& [place, batch] : batches) {
      const auto& [all, number] = batch;
      if (number * each < side * side / 2) continue;
      batch_.square += (all / number) * (all / number) * number * each;
      ++batch_.count;
    }
    batch_.count -= std::min(batch_.count, is_flat() ? 1.0 : 3.0);  // what the plane took
  }

 public:
  /// Σ mean² · area of batches of the differences, and how many are independent.
  struct Batches {
    double square = 0, count = 0;
  };
  [[nodiscard]] auto batches() const -> const Batches& { return batch_; }
  /// The noise of this building, σ² A, where its batches show more.
  void set_chance(double square_area) { chance_ = std::max(chance_, square_area); }

 private:
  Batches batch_;

  Point3 normal_, corner_;
  double area_ = 0, lowest_ = 0, highest_ = 0;
  bool seen_ = false;
  Point2 centre_;
  Row off_{};                        ///< of the scan above the face: m at the centre, m/m
  double xx_ = 1, xy_ = 0, yy_ = 1;  ///< m²; second moments of the samples
  double chance_ = 0;                ///< m²·m²; σ² A
  double ground_ = 1;                ///< m² in plan that has samples
};

/// Sets the noise of all faces to that of their batches together, where that is more.
void share_noise(std::vector<std::vector<std::optional<RoofFace>>>& faces) {
  double square = 0, count = 0;
  for (const auto& solid : faces)
    for (const auto& face : solid)
      if (face) square += face->batches().square, count += face->batches().count;
  if (!(count > 0)) return;
  for (auto& solid : faces)
    for (auto& face : solid)
      if (face) face->set_chance(square / count);
}

/// All that the errors of one building are made of.
struct Errors {
  std::vector<std::vector<std::optional<RoofFace>>> faces;  ///< of every solid
  double wall = 0;                                          ///< m²; variance of the position of a wall
  double offset_error = 0;                                  ///< m, of all walls alike

  /// Of a height where a face ends at a wall, beside that of the face.
  [[nodiscard]] auto of_end(const RoofFace& face) const -> double {
    return face.slope() * face.slope() * (wall + offset_error * offset_error);
  }
  [[nodiscard]] auto at_wall(const RoofFace& face, Point2 p) const -> Variance {
    return sum(face.variance(p), of_end(face));
  }
};

/// A height that some faces decide, independently: the variance of their mean.
auto of_corner(const Errors& errors, const model::LabelledSolid& model,
               const std::vector<std::optional<RoofFace>>& faces, std::uint32_t corner, bool pitched) -> Variance {
  Variance total = 0.0;
  double count = 0, end = 0;
  const Point2 p = xy(model.solid.vertices[corner]);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!faces[f] || (pitched && model.solid.faces[f].kind != model::FaceKind::side)) continue;
    const auto& loop = model.solid.faces[f].loops.front();
    if (std::ranges::find(loop, corner) == loop.end()) continue;
    total = sum(total, faces[f]->variance(p));
    end = errors.of_end(*faces[f]);
    ++count;
  }
  if (count == 0) return std::nullopt;
  // Where one face ends there is a wall.
  return sum(times(1 / (count * count), total), count > 1 ? 0 : end);
}

/// Of the height that a share of the roof is below: of the faces that are at that height.
auto of_percentile(const Errors& errors, double z) -> Variance {
  Variance total = 0.0;
  double weights = 0;
  constexpr double same = 0.01;  // m
  for (const auto& solid : errors.faces)
    for (const auto& face : solid) {
      if (!face || face->lowest() > z + same || face->highest() < z - same) continue;
      const double weight = face->ground() / (face->highest() - face->lowest() + same);
      // Half of its height is half of its run inward, and a wall that is moved moves the far end of the face by half.
      constexpr double moved = 0.25;
      const double run = moved * moved * face->slope() * face->slope() * errors.wall;
      total = sum(total, times(weight * weight, sum(face->variance(face->centre()), run)));
      weights += weight;
    }
  if (!(weights > 0)) return std::nullopt;
  return times(1 / (weights * weights), total);
}

/// m², of the distance of a wall from its place after the common offset.
auto wall_variance(const model::Accuracy& scan) -> double {
  // A block of one house may have too few walls to tell footprints from scan: then as the end of its roof is seen.
  if (!(scan.edges > 0)) return scan.edge_noise * scan.edge_noise;
  // The spread contains how well a wall is seen: the error of the median of its transects (Kenney, Keeping 1962).
  constexpr double of_median = std::numbers::pi / 2;
  const auto edges = static_cast<double>(scan.edges), each = static_cast<double>(scan.transects) / edges;
  const double spread = scan.offset_spread * scan.offset_spread;
  const double seen = of_median * scan.edge_noise * scan.edge_noise / std::max(1.0, each);
  return std::max(spread - seen, std::sqrt(2 / edges) * spread);  // the standard error of a variance
}

/// m: how far the scan is above a roof along its edge, beyond its noise: a parapet or a gutter that the model lacks.
auto rim_above(const model::Solid& solid, const solid::Line& line, bool roof_is_left, const RoofFace& roof,
               const Evidence& evidence) -> double {
  constexpr double step = 0.5, breadth = 0.4, across = 0.1;  // m
  const Point3 a = solid.vertices[line.from], b = solid.vertices[line.to];
  const Point2 along = xy(b) - xy(a);
  const double length = geometry::length(along);
  if (!(length > 2 * step)) return 0;
  const Point2 inward = (roof_is_left ? 1 : -1) / length * left_of(along);
  std::vector<double> above;
  for (double at = step; at <= length - step; at += step) {
    std::optional<double> most;
    for (double in = across; in <= breadth; in += across) {
      const Point2 p = xy(a) + (at / length) * along + in * inward;
      if (const auto z = evidence.mesh.top(p)) most = std::max(most.value_or(*z - roof.at(p)), *z - roof.at(p));
    }
    if (most) above.push_back(*most);
  }
  if (above.empty()) return 0;
  return std::max(0.0, base::median(std::move(above)) - 2 * evidence.accuracy.noise);
}

}  // namespace

auto standard_errors(const model::Building& building, const Evidence& evidence) -> model::Attributes {
  const auto solids = solids_of(building);
  model::Attributes out;
  const auto add = [&](const char* name, Variance variance) {
    if (variance) out.emplace_back(name, std::sqrt(*variance));
  };
  // What the adjustment of a survey leaves between its images, tiles or strips is the same over a building, and does
  // not show there. Standards allow about as much as noise (USGS Lidar Base Specification: 6 cm within a swath, 8 cm
  // between two); half of the noise is what `mansard simulate` plants (its seams). It moves ground and roof alike.
  constexpr double common_share = 0.5, adjusted = 0.02;  // m
  const double common = std::min(common_share * evidence.accuracy.noise, adjusted);
  const auto add_height = [&](const char* name, Variance variance) { add(name, sum(variance, common * common)); };
  const Variance ground =
      evidence.ground_error ? Variance(*evidence.ground_error * *evidence.ground_error) : std::nullopt;
  add_height("ms_h_ground_se", ground);
  if (solids.empty()) return out;
  const auto& scan = evidence.accuracy;
  Errors errors;
  errors.wall = wall_variance(scan);
  errors.offset_error = scan.offset_error;
  Variance volume = 0.0;
  double area_ground = 0;
  Variance wall = 0.0, party = 0.0;
  double wall_length = 0, party_length = 0;
  struct Corner {
    double z = 0;
    Variance variance;
  };
  std::optional<Corner> lowest, highest, ridge;
  for (const auto* one : solids) {
    auto& faces = errors.faces.emplace_back(one->classes.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (one->classes[f] == FaceClass::roof && one->solid.faces[f].normal.z > 0)
        faces[f].emplace(one->solid, f, evidence);
  }
  share_noise(errors.faces);
  for (std::size_t n = 0; n < solids.size(); ++n) {
    const auto* one = solids[n];
    const auto& faces = errors.faces[n];
    double base = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (one->classes[f] == FaceClass::ground) base += solid::area(one->solid, one->solid.faces[f]);
      if (faces[f])
        volume = sum(volume, times(faces[f]->ground() * faces[f]->ground(), faces[f]->variance(faces[f]->centre())));
      if (one->classes[f] == FaceClass::wall || one->classes[f] == FaceClass::party_wall) {
        const double area = solid::area(one->solid, one->solid.faces[f]);
        volume = sum(volume, area * area * errors.wall);
        // The walls beside it move its two ends.
        double low = 1e9, high = -1e9;
        for (const auto v : one->solid.faces[f].loops.front())
          low = std::min(low, one->solid.vertices[v].z), high = std::max(high, one->solid.vertices[v].z);
        auto& of = one->classes[f] == FaceClass::party_wall ? party : wall;
        of = sum(of, 2 * (high - low) * (high - low) * errors.wall);
      }
      if (!faces[f]) continue;
      for (const auto v : one->solid.faces[f].loops.front()) {
        const double z = one->solid.vertices[v].z;
        const auto take = [&](std::optional<Corner>& corner, bool better, bool pitched) {
          if (!corner || better) corner = Corner{z, of_corner(errors, *one, faces, v, pitched)};
        };
        take(lowest, lowest && z < lowest->z, false);
        take(highest, highest && z > highest->z, false);
        if (one->solid.faces[f].kind == model::FaceKind::side) take(ridge, ridge && z > ridge->z, true);
      }
    }
    volume = sum(volume, times(base * base, ground));
    const auto lines = solid::lines(one->solid);
    if (!lines) continue;
    for (const auto& line : *lines) {
      const auto a = one->solid.vertices[line.from], b = one->solid.vertices[line.to];
      const double length = geometry::length(xy(b) - xy(a));
      const auto left = one->classes[line.left_face], right = one->classes[line.right_face];
      const auto is_wall = [](FaceClass kind) { return kind == FaceClass::wall || kind == FaceClass::party_wall; };
      if (left == FaceClass::ground || right == FaceClass::ground) area_ground += length * length * errors.wall;
      for (const auto& [roof, other] :
           {std::pair(line.left_face, line.right_face), std::pair(line.right_face, line.left_face)}) {
        if (!faces[roof] || !is_wall(one->classes[other])) continue;
        const auto top = errors.at_wall(*faces[roof], xy(0.5 * (a + b)));
        const bool shared = one->classes[other] == FaceClass::party_wall;
        (shared ? party : wall) = sum(shared ? party : wall, times(length * length, top));
      }
      if (left == FaceClass::ground || right == FaceClass::ground) {
        const auto side = left == FaceClass::ground ? right : left;
        (side == FaceClass::party_wall ? party_length : wall_length) += length;
      }
    }
  }
  Variance eave;
  double rim_of_highest = 0, rim_of_lowest = 0;
  if (const auto eaves = eaves_of(solids); !eaves.empty()) {
    // A step more or less in the roof moves the middle of the length by so much: where eaves are on two levels it may
    // be the other one.
    constexpr double moved = 0.1;
    const double levels = eave_at(eaves, 0.5 + moved).z - eave_at(eaves, 0.5 - moved).z;
    const auto rim = [&](const Eave& one) {
      const auto& solid = solids[one.solid]->solid;
      const auto& faces = errors.faces[one.solid];
      const auto roof = faces[one.line.left_face] ? one.line.left_face : one.line.right_face;
      return faces[roof] ? rim_above(solid, one.line, roof == one.line.left_face, *faces[roof], evidence) : 0;
    };
    const auto& middle = eave_at(eaves, 0.5);
    const auto& solid = solids[middle.solid]->solid;
    const Point2 p = xy(0.5 * (solid.vertices[middle.line.from] + solid.vertices[middle.line.to]));
    for (const auto face : {middle.line.left_face, middle.line.right_face})
      if (const auto& roof = errors.faces[middle.solid][face]) eave = errors.at_wall(*roof, p);
    const double above = rim(middle);
    eave = sum(eave, levels * levels / 4 + above * above);
    constexpr double same = 0.01;  // m
    for (const auto& one : eaves) {
      if (highest && one.z > highest->z - same) rim_of_highest = std::max(rim_of_highest, rim(one));
      if (lowest && one.z < lowest->z + same) rim_of_lowest = std::max(rim_of_lowest, rim(one));
    }
  }
  if (highest) highest->variance = sum(highest->variance, rim_of_highest * rim_of_highest);
  if (lowest) lowest->variance = sum(lowest->variance, rim_of_lowest * rim_of_lowest);
  if (lowest) add_height("ms_h_roof_min_se", lowest->variance);
  const auto all = together(solids);
  const auto percentile = [&](double share) { return of_percentile(errors, solid::roof_percentile(all, share)); };
  add_height("ms_h_roof_50p_se", percentile(0.5));
  add_height("ms_h_roof_70p_se", percentile(0.7));
  if (highest) add_height("ms_h_roof_max_se", highest->variance);
  add_height("ms_h_eave_se", eave);
  if (ridge) add_height("ms_h_ridge_se", ridge->variance);
  add("ms_volume_lod22_se", volume);
  add("ms_area_ground_se", area_ground);
  add("ms_area_wall_se", sum(wall, times(wall_length * wall_length, ground)));
  add("ms_area_party_wall_se", sum(party, times(party_length * party_length, ground)));
  return out;
}

}  // namespace mansard::report
