#include "mansard/segment/detail/parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "mansard/base/text.hpp"
#include "mansard/segment/detail/origins.hpp"
#include "mansard/segment/detail/rings.hpp"

namespace mansard::segment::detail {
namespace {

using LabelOfFace = std::vector<std::optional<std::uint32_t>>;

/// Faces by label, labels and faces ascending.
auto faces_by_label(const LabelOfFace& label_of_face) -> std::map<std::uint32_t, std::vector<std::uint32_t>> {
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces;
  for (std::uint32_t f = 0; f < label_of_face.size(); ++f)
    if (const auto& label = label_of_face[f]) faces[*label].push_back(f);
  return faces;
}

auto area_of(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces) -> double {
  double sum = 0;
  for (const std::uint32_t f : faces) sum += arrangement.faces[f].area;
  return sum;
}

auto feature_of(const fracture::Arrangement& arrangement, const Evidence& evidence,
                const std::vector<std::uint32_t>& faces) -> std::optional<std::size_t> {
  std::map<std::size_t, double> area;
  for (const std::uint32_t f : faces)
    for (const auto& [feature, share] : evidence.samples[f].shares) area[feature] += share * arrangement.faces[f].area;
  std::optional<std::size_t> best;
  for (const auto& [feature, a] : area)
    if (!best || a > area[*best]) best = feature;
  return best;
}

/// The label across the longest common boundary among labels of the same feature.
auto best_neighbour(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces,
                    const LabelOfFace& label_of_face,
                    const std::map<std::uint32_t, std::optional<std::size_t>>& feature_of_label)
    -> std::optional<std::uint32_t> {
  const auto& own = label_of_face[faces.front()];
  if (!own) return std::nullopt;
  const std::uint32_t label = *own;
  std::map<std::uint32_t, double> common;
  for (const std::uint32_t f : faces)
    for (const std::uint32_t h : half_edges_around(arrangement, f)) {
      const auto other = face_across(arrangement, h);
      if (!other) continue;
      const auto& beyond = label_of_face[*other];
      if (beyond && *beyond != label && feature_of_label.at(*beyond) == feature_of_label.at(label))
        common[*beyond] += length_of(arrangement, h);
    }
  std::optional<std::uint32_t> best;
  for (const auto& [l, length] : common)
    if (!best || length > common[*best]) best = l;
  return best;
}

/// A height of the mesh's top surface, and the area that it stands for.
using WeightedHeight = std::pair<double, double>;

/// The samples of the faces, ascending; where the mesh showed nothing, one for each face.
auto heights_of(const fracture::Arrangement& arrangement, const Evidence& evidence,
                const std::vector<std::uint32_t>& faces) -> std::vector<WeightedHeight> {
  std::vector<WeightedHeight> weighted;
  for (const std::uint32_t f : faces) {
    const auto& heights = evidence.samples[f].heights;
    const double area = arrangement.faces[f].area / static_cast<double>(std::max<std::size_t>(heights.size(), 1));
    for (const double z : heights) weighted.emplace_back(z, area);
  }
  if (weighted.empty())
    for (const std::uint32_t f : faces) weighted.emplace_back(evidence.faces[f].height, arrangement.faces[f].area);
  std::ranges::sort(weighted);
  return weighted;
}

/// Median, by area.
auto height_of(const fracture::Arrangement& arrangement, const Evidence& evidence,
               const std::vector<std::uint32_t>& faces) -> double {
  const auto weighted = heights_of(arrangement, evidence, faces);
  double total = 0, sum = 0;
  for (const auto& [z, area] : weighted) total += area;
  for (const auto& [z, area] : weighted)
    if ((sum += area) >= total / 2) return z;
  return weighted.back().first;
}

/// m² of the faces within their feature's footprint.
auto area_within(const fracture::Arrangement& arrangement, const Evidence& evidence,
                 const std::vector<std::uint32_t>& faces, std::optional<std::size_t> feature) -> double {
  double sum = 0;
  for (const std::uint32_t f : faces)
    for (const auto& [of, share] : evidence.samples[f].shares)
      if (of == feature) sum += share * arrangement.faces[f].area;
  return sum;
}

/// 2 × area over perimeter: the width of a long strip.
auto width_of(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces,
              const LabelOfFace& label_of_face, double area) -> double {
  double perimeter = 0;
  for (const std::uint32_t f : faces)
    for (const std::uint32_t h : half_edges_around(arrangement, f)) {
      const auto other = face_across(arrangement, h);
      if (!other || label_of_face[*other] != label_of_face[f]) perimeter += length_of(arrangement, h);
    }
  return 2 * area / perimeter;
}

auto reaches_outside(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces,
                     const LabelOfFace& label_of_face) -> bool {
  return std::ranges::any_of(faces, [&](std::uint32_t f) {
    return std::ranges::any_of(half_edges_around(arrangement, f), [&](std::uint32_t h) {
      const auto other = face_across(arrangement, h);
      return !other || !label_of_face[*other];
    });
  });
}

/// Parts too small or too narrow to be a building of their own go to their neighbour in the same feature. A low strip
/// along the outside stays: it is a roof, or the blurred wall between its neighbour and a footprint drawn too wide.
void take_up_small_parts(const fracture::Arrangement& arrangement, const Evidence& evidence, LabelOfFace& label_of_face,
                         const Options& o, Segmentation& segmentation) {
  auto& warnings = segmentation.warnings;
  auto faces = faces_by_label(label_of_face);
  std::map<std::uint32_t, std::optional<std::size_t>> features;
  std::set<std::pair<double, std::uint32_t>> small;  // area and label; without those that stay as they are
  std::set<std::uint32_t> kept;                      // narrow, but all there is of their feature
  // What joins one part changes nothing about any other: which feature, how large and how narrow it is.
  const auto measure = [&](std::uint32_t label) {
    const auto& members = faces.at(label);
    features[label] = feature_of(arrangement, evidence, members);
    const double area = area_of(arrangement, members);
    if (kept.contains(label)) return;
    if (area < o.smallest_part || width_of(arrangement, members, label_of_face, area) < o.narrow)
      small.emplace(area, label);
  };
  for (const auto& [label, members] : faces) measure(label);
  while (!small.empty()) {
    const auto [area, label] = *small.begin();
    small.erase(small.begin());
    const auto members = faces.at(label);
    const auto into = best_neighbour(arrangement, members, label_of_face, features);
    if (area >= o.smallest_part && !into) {
      kept.insert(label);
      continue;
    }
    const double own = height_of(arrangement, evidence, members), ground = evidence.ground[members.front()];
    const double next = into ? height_of(arrangement, evidence, faces.at(*into)) : own;
    const bool apart = into && area >= o.smallest_part && reaches_outside(arrangement, members, label_of_face) &&
                       own - ground < o.low_share * (next - ground);
    if (apart) {
      kept.insert(label);
      continue;
    }
    if (!into)
      segmentation.left_out.push_back({features.at(label),
                                       area_within(arrangement, evidence, members, features.at(label)), own - ground,
                                       "too small for a part, without a neighbour"});
    for (const std::uint32_t f : members) label_of_face[f] = into;
    faces.erase(label);
    if (into) {
      small.erase({area_of(arrangement, faces.at(*into)), *into});
      auto& joined = faces.at(*into);
      const auto middle = joined.insert(joined.end(), members.begin(), members.end());
      std::inplace_merge(joined.begin(), middle, joined.end());  // ascending, so that sums do not depend on the order
      measure(*into);
    }
    warnings.push_back(
        base::warning("segment-part-small",
                      "a part of " + base::to_text(area, 2) + " m² " +
                          (into ? "was joined to its neighbour" : "was left out: it has no neighbour to join"),
                      "face " + std::to_string(members.front())));
  }
}

auto is_simple(const std::vector<CornerRing>& rings) -> bool {
  return std::ranges::all_of(rings, [](const CornerRing& ring) { return ring.size() >= 3; }) &&
         geometry::is_simple(polygon_of(rings));
}

/// For outlines that opening does not make simple: shrunk, the largest piece.
auto repaired(const std::vector<CornerRing>& rings, const Options& o, Part& part) -> bool {
  auto valid = geometry::make_valid(polygon_of(rings));
  if (!valid) return false;
  std::optional<geometry::Polygon> best;
  for (const auto& piece : *valid) {
    const auto shrunk = geometry::buffer(piece, -o.opening);
    if (!shrunk) continue;
    for (const auto& p : *shrunk)
      if (geometry::is_simple(p) && (!best || geometry::area(p) > geometry::area(*best))) best = p;
  }
  if (!best || geometry::area(*best) < o.smallest_part) return false;
  part.polygon = *best;
  return true;
}

/// Polygon of a part; false where no simple polygon of 1 m² could be made of it.
auto draw(const fracture::Arrangement& arrangement, const LabelOfFace& part_of_face, std::uint32_t number,
          const Options& o, Part& part, std::vector<base::Diagnostic>& warnings) -> bool {
  const std::vector<CornerRing> traced = trace(arrangement, part.faces, part_of_face);
  for (const double tolerance : {o.collinear, 0.0}) {
    const std::vector<CornerRing> rings = opened(straightened(traced, tolerance), o.opening);
    if (!is_simple(rings)) continue;
    part.polygon = polygon_of(rings);
    return true;
  }
  const std::string subject = "part " + std::to_string(number);
  if (repaired(traced, o, part)) {
    warnings.push_back(base::warning("segment-part-repaired", "its outline crossed itself and was redrawn", subject));
    return true;
  }
  warnings.push_back(base::warning("segment-part-dropped", "no simple outline could be made of it; left out", subject));
  return false;
}

}  // namespace

void make_parts(const fracture::Arrangement& arrangement, const Evidence& evidence, LabelOfFace label_of_face,
                const Options& options, Segmentation& segmentation) {
  take_up_small_parts(arrangement, evidence, label_of_face, options, segmentation);

  for (;;) {
    struct Order {
      bool without;
      std::size_t feature;
      std::uint32_t lowest, label;
      auto operator<=>(const Order&) const = default;
    };
    const auto faces = faces_by_label(label_of_face);
    std::vector<Order> order;
    for (const auto& [label, members] : faces) {
      const auto feature = feature_of(arrangement, evidence, members);
      order.push_back({!feature, feature.value_or(0), members.front(), label});
    }
    std::ranges::sort(order);

    segmentation.parts.clear();
    segmentation.part_of_face.assign(arrangement.faces.size(), std::nullopt);
    for (std::uint32_t p = 0; p < order.size(); ++p)
      for (const std::uint32_t f : faces.at(order[p].label)) segmentation.part_of_face[f] = p;

    std::vector<base::Diagnostic> warnings;
    bool dropped = false;
    for (std::uint32_t p = 0; p < order.size(); ++p) {
      Part part;
      part.faces = faces.at(order[p].label);
      if (!order[p].without) part.feature = order[p].feature;
      part.height = height_of(arrangement, evidence, part.faces);
      if (!draw(arrangement, segmentation.part_of_face, p, options, part, warnings)) {
        // Its faces belong to nothing then, and the others are numbered again.
        for (const std::uint32_t f : part.faces) label_of_face[f] = std::nullopt;
        segmentation.left_out.push_back({part.feature, area_within(arrangement, evidence, part.faces, part.feature),
                                         part.height - evidence.ground[part.faces.front()],
                                         "no simple outline could be made of it"});
        segmentation.warnings.push_back(warnings.back());
        dropped = true;
        break;
      }
      segmentation.parts.push_back(std::move(part));
    }
    if (dropped) continue;
    for (auto& w : warnings) segmentation.warnings.push_back(std::move(w));
    break;
  }
  for (Candidate& c : segmentation.candidates)
    c.chosen = segmentation.part_of_face[c.left] != segmentation.part_of_face[c.right];
}

}  // namespace mansard::segment::detail
