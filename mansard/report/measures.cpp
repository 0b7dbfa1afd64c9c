#include "mansard/report/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/label/label.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/solid/half_edges.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::report {
namespace {

using geometry::Point2;
using model::LabelledSolid;

struct RoofLines {
  std::optional<double> eave;  ///< z
  std::int64_t ridges = 0;
};

/// Ridges that go straight on at a corner are one.
auto count_ridges(const model::Solid& solid, const std::vector<solid::Line>& ridges) -> std::size_t {
  constexpr double straight = 0.9998;  // cosine of 1°
  base::DisjointSets sets(ridges.size());
  const auto direction = [&](const solid::Line& line) {
    return geometry::normalised(solid.vertices[line.to] - solid.vertices[line.from]);
  };
  for (std::uint32_t i = 0; i < ridges.size(); ++i)
    for (std::uint32_t k = 0; k < i; ++k) {
      const auto &a = ridges[i], &b = ridges[k];
      const bool meet = a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to;
      if (meet && std::abs(dot(direction(a), direction(b))) > straight) sets.join(i, k);
    }
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < ridges.size(); ++i) count += sets.of(i) == i ? 1 : 0;
  return count;
}

/// What a roof's line is to those who count ridges and measure eaves. The kinds of solid::lines are exact, for solids
/// as they are extruded; united and on the grid of the files, what was level is so within a quantum or two, and the
/// normals of faces are as exact as their rounded corners.
enum class RoofLine : std::uint8_t { eave, ridge, other };

auto roof_line(const LabelledSolid& model, const solid::Line& line) -> RoofLine {
  constexpr double level = 1.05e-3;          // m; half-way between whole units of the files, so that none is on it
  constexpr double rises = 1e-3;             // 0.06°
  constexpr double ridge_inclined = 0.0872;  // sine of 5°
  constexpr double flat = 0.99996;           // cosine of 0.5°
  using enum model::FaceClass;
  const auto a = model.solid.vertices[line.from], b = model.solid.vertices[line.to];
  const auto left = model.classes[line.left_face], right = model.classes[line.right_face];
  if ((left == soffit && right == roof) || (left == roof && right == soffit)) return RoofLine::eave;
  if (!(length(b - a) > 0)) return RoofLine::other;
  const auto n = model.solid.faces[line.left_face].normal, m = model.solid.faces[line.right_face].normal;
  const auto along = geometry::normalised(b - a);
  if (!(dot(cross(n, m), along) > 0)) return RoofLine::other;               // not convex
  const double in_left = cross(n, along).z, in_right = -cross(m, along).z;  // from the line into each face
  if (left == roof && right == roof) {
    // Of a house whose sides are not quite parallel the ridge is inclined.
    const bool ridge = std::abs(along.z) < ridge_inclined && in_left < -rises && in_right < -rises;
    return ridge ? RoofLine::ridge : RoofLine::other;
  }
  if ((left != roof && right != roof) || std::abs(a.z - b.z) > level) return RoofLine::other;
  const bool is_flat = (left == roof ? n : m).z > flat;
  return is_flat || (left == roof ? in_left : in_right) > rises ? RoofLine::eave : RoofLine::other;
}

}  // namespace

auto eaves_of(const std::vector<const LabelledSolid*>& solids) -> std::vector<Eave> {
  std::vector<Eave> eaves;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const auto& solid = solids[s]->solid;
    const auto lines = solid::lines(solid);
    if (!lines) continue;
    for (const auto& line : *lines) {
      if (roof_line(*solids[s], line) != RoofLine::eave) continue;
      // A corner's height and lengths in whole units of the files: the same wherever the building stands. Sums of whole
      // numbers are exact, so that no rounding decides where two heights have half of the length each.
      constexpr double units_per_metre = 1e4;
      const auto a = solid.vertices[line.from], b = solid.vertices[line.to];
      const auto whole = [](double metres) { return std::round(metres * units_per_metre); };
      eaves.push_back({s, line, std::min(a.z, b.z), std::round(std::hypot(whole(b.x - a.x), whole(b.y - a.y)))});
    }
  }
  std::ranges::sort(eaves, {},
                    [](const Eave& e) { return std::tuple(e.z, e.length, e.solid, e.line.from, e.line.to); });
  return eaves;
}

auto eave_at(const std::vector<Eave>& eaves, double share) -> const Eave& {
  double all = 0, before = 0;
  for (const auto& eave : eaves) all += eave.length;
  for (const auto& eave : eaves)
    if ((before += eave.length) >= share * all) return eave;
  return eaves.back();
}

namespace {

/// The height of the eaves is that below which half of their length lies.
auto lines_of(const std::vector<const LabelledSolid*>& solids) -> RoofLines {
  RoofLines out;
  for (const auto* one : solids) {
    const auto lines = solid::lines(one->solid);
    if (!lines) continue;
    std::vector<solid::Line> ridges;
    for (const auto& line : *lines)
      if (roof_line(*one, line) == RoofLine::ridge) ridges.push_back(line);
    out.ridges += static_cast<std::int64_t>(count_ridges(one->solid, ridges));
  }
  if (const auto eaves = eaves_of(solids); !eaves.empty()) out.eave = eave_at(eaves, 0.5).z;
  return out;
}

/// The code of CityGML's code list RoofType (SIG 3D): 1000 flat, 1010 monopitch, 1030 gabled, 1040 hipped, 1130 a
/// combination.
auto roof_code(const LabelledSolid& model, const std::string& type, std::int64_t ridges) -> std::string {
  if (type != "slanted") return "1000";
  constexpr double flat = 0.9962, same = 0.966;  // cosines of 5° and 15°
  std::vector<Point2> directions;
  for (std::size_t f = 0; f < model.classes.size(); ++f) {
    const auto n = model.solid.faces[f].normal;
    if (model.classes[f] != model::FaceClass::roof) continue;
    if (n.z >= flat) return "1130";
    const Point2 towards = geometry::normalised(xy(n));
    if (std::ranges::none_of(directions, [&](Point2 d) { return dot(d, towards) > same; }))
      directions.push_back(towards);
  }
  if (directions.size() == 1) return "1010";
  if (ridges > 1) return "1130";
  if (directions.size() == 2 && dot(directions[0], directions[1]) < -same) return "1030";
  return directions.size() == 4 ? "1040" : "1130";
}

auto footprint_area(const model::Building& building) -> double {
  double area = 0;
  for (const auto& polygon : building.footprint) area += geometry::area(geometry::oriented(polygon));
  return area;
}

auto has(const model::Attributes& attributes, std::string_view name) -> bool {
  return std::ranges::find(attributes, name, &model::Attributes::value_type::first) != attributes.end();
}

}  // namespace

auto solids_of(const model::Building& building) -> std::vector<const LabelledSolid*> {
  std::vector<const LabelledSolid*> out;
  for (const auto& solid : building.solids) out.push_back(&solid.model);
  if (out.empty())
    for (const auto& part : building.parts)
      if (!part.model.solid.faces.empty()) out.push_back(&part.model);
  return out;
}

auto together(const std::vector<const LabelledSolid*>& solids) -> LabelledSolid {
  LabelledSolid out;
  for (const auto* one : solids) {
    const auto first = static_cast<std::uint32_t>(out.solid.vertices.size());
    out.solid.vertices.insert(out.solid.vertices.end(), one->solid.vertices.begin(), one->solid.vertices.end());
    for (model::Face face : one->solid.faces) {
      for (auto& loop : face.loops)
        for (auto& v : loop) v += first;
      out.solid.faces.push_back(std::move(face));
    }
    out.classes.insert(out.classes.end(), one->classes.begin(), one->classes.end());
  }
  return out;
}

auto building_measures(const model::Building& building, double z0, double storey, std::optional<double> ground_mean)
    -> model::Attributes {
  model::Attributes out;
  if (!building.footprint.empty()) out.emplace_back("ms_area_footprint", footprint_area(building));
  const auto solids = solids_of(building);
  if (solids.empty()) return out;
  const auto all = together(solids);
  double lowest = std::numeric_limits<double>::infinity(), bottom = lowest;
  std::int64_t planes = 0;
  for (std::size_t f = 0; f < all.classes.size(); ++f)
    for (const auto v : all.solid.faces[f].loops.front()) {
      const double z = all.solid.vertices[v].z;
      bottom = std::min(bottom, z);
      if (all.classes[f] == model::FaceClass::roof) lowest = std::min(lowest, z);
    }
  for (const auto kind : all.classes) planes += kind == model::FaceClass::roof ? 1 : 0;
  const auto lines = lines_of(solids);
  const double top = top_of(all.solid), h70 = solid::roof_percentile(all, 0.7);
  const auto areas = label::areas(all);
  const std::string type = roof_type(all);
  if (std::isfinite(lowest)) out.emplace_back("ms_h_roof_min", z0 + lowest);
  out.emplace_back("ms_h_roof_50p", z0 + solid::roof_percentile(all, 0.5));
  out.emplace_back("ms_h_roof_70p", z0 + h70);
  if (lines.eave) out.emplace_back("ms_h_eave", z0 + *lines.eave);
  if (const auto ridge = ridge_height(all)) out.emplace_back("ms_h_ridge", z0 + *ridge);
  out.emplace_back("ms_roof_type", type);
  out.emplace_back("ms_roof_planes", planes);
  out.emplace_back("ms_ridges", lines.ridges);
  out.emplace_back("ms_parts", static_cast<std::int64_t>(building.parts.size()));
  out.emplace_back("ms_area_ground", areas.ground);
  out.emplace_back("ms_area_roof_flat", areas.roof_flat);
  out.emplace_back("ms_area_roof_sloped", areas.roof_sloped);
  out.emplace_back("ms_area_wall", areas.wall);
  out.emplace_back("ms_area_party_wall", areas.party_wall);
  // What is above the eaves of a sloped roof counts to where 70 % of it is.
  const auto storeys = std::max(
      std::int64_t{1}, static_cast<std::int64_t>(std::floor((h70 - ground_mean.value_or(bottom)) / storey + 0.5)));
  out.emplace_back("ms_storeys", storeys);
  if (!has(building.attributes, "measuredHeight")) out.emplace_back("measuredHeight", rounded_measure(top - bottom));
  if (!has(building.attributes, "roofType")) out.emplace_back("roofType", roof_code(all, type, lines.ridges));
  if (!has(building.attributes, "storeysAboveGround")) out.emplace_back("storeysAboveGround", storeys);
  return out;
}

auto level_names() -> std::span<const LevelNames> {
  using enum formats::Lod;
  static constexpr std::array<LevelNames, 4> all{{
      {lod12, "ms_volume_lod12", "ms_surface_lod12", "ms_rmse_lod12", "ms_val3dity_lod12"},
      {lod13, "ms_volume_lod13", "ms_surface_lod13", "ms_rmse_lod13", "ms_val3dity_lod13"},
      {lod20, "ms_volume_lod20", "ms_surface_lod20", "ms_rmse_lod20", "ms_val3dity_lod20"},
      {lod22, "ms_volume_lod22", "ms_surface_lod22", "ms_rmse_lod22", "ms_val3dity_lod22"},
  }};
  return all;
}

auto level_names(formats::Lod lod) -> const LevelNames& {
  return *std::ranges::find(level_names(), lod, &LevelNames::lod);
}

auto level_measures(const model::Building& building, const model::Frame& frame, const solid::LevelOptions& options,
                    const rays::Scene* mesh, const evaluate::Options& error_options) -> model::Attributes {
  model::Attributes out;
  const auto all = formats::levels_of(building, frame, options);
  if (all.empty()) return out;
  for (const auto& names : level_names()) {
    const auto lod = names.lod;
    double volume = 0, surface = 0, squared = 0, seen = 0;
    std::vector<base::Diagnostic> wrong;
    std::vector<const model::LabelledSolid*> solids;
    bool made = true;
    for (const auto& levels : all) {
      const auto& model = levels.at(lod);
      if (model.solid.faces.empty()) {
        made = false;
        break;
      }
      volume += solid::volume(model.solid);
      for (const auto& face : model.solid.faces) surface += solid::area(model.solid, face);
      const auto found = solid::check(model.solid, solid::written_rules());
      wrong.insert(wrong.end(), found.begin(), found.end());
      solids.push_back(&model);
      if (mesh == nullptr || lod == formats::Lod::lod22) continue;
      for (std::size_t f = 0; f < model.classes.size(); ++f) {
        if (model.classes[f] != model::FaceClass::ground) continue;
        const auto ground = geometry::oriented(geometry::polygon_of(
            model.solid.faces[f].loops, [&](std::uint32_t v) { return xy(model.solid.vertices[v]); }));
        const double error = evaluate::error_over(model.solid, ground, *mesh, error_options),
                     area = geometry::area(ground);
        if (!std::isfinite(error)) continue;
        squared += error * area;
        seen += area;
      }
    }
    if (!made) continue;
    for (auto& one : solid::overlapping(solids)) wrong.push_back(std::move(one.what));
    if (lod != formats::Lod::lod22) out.emplace_back(names.volume, volume);
    out.emplace_back(names.surface, surface);
    if (seen > 0) out.emplace_back(names.rmse, std::sqrt(squared / seen));
    std::string codes;
    for (const int code : solid::val3dity_codes(wrong)) codes += (codes.empty() ? "" : ", ") + std::to_string(code);
    out.emplace_back(names.val3dity, "[" + codes + "]");
  }
  return out;
}

namespace {

/// A grid over polygons: cells that lie in them and have no surface.
struct Empty {
  std::size_t columns = 0, rows = 0;
  std::vector<bool> cells;
};

/// The squared distance in cells to the nearest cell that is not empty, at most; 0 without empty cells.
auto widest(const Empty& empty) -> double {
  // Distances in the columns, then over the rows (Meijster, Roerdink and Hesselink 2000).
  const auto at = [&](std::size_t x, std::size_t y) { return y * empty.columns + x; };
  const auto far = static_cast<std::int64_t>(empty.rows + empty.columns + 1);
  std::vector<std::int64_t> up(empty.cells.size());
  for (std::size_t x = 0; x < empty.columns; ++x) {
    std::int64_t since = 0;  // the grid ends where the polygons do
    for (std::size_t y = 0; y < empty.rows; ++y) up[at(x, y)] = since = empty.cells[at(x, y)] ? since + 1 : 0;
    since = 0;
    for (std::size_t y = empty.rows; y-- > 0;) {
      since = empty.cells[at(x, y)] ? since + 1 : 0;
      up[at(x, y)] = std::min(up[at(x, y)], since);
    }
  }
  std::int64_t most = 0;
  for (std::size_t y = 0; y < empty.rows; ++y)
    for (std::size_t x = 0; x < empty.columns; ++x) {
      if (!empty.cells[at(x, y)]) continue;
      std::int64_t best = far * far;
      for (std::int64_t d = 0; d * d < best; ++d)
        for (const std::int64_t side : {d, -d}) {
          const auto other = static_cast<std::int64_t>(x) + side;
          const bool inside = other >= 0 && other < static_cast<std::int64_t>(empty.columns);
          const auto height = inside ? up[at(static_cast<std::size_t>(other), y)] : 0;
          best = std::min(best, d * d + height * height);
        }
      most = std::max(most, best);
    }
  return static_cast<double>(most);
}

}  // namespace

auto coverage(const rays::Scene& mesh, std::span<const geometry::Polygon> polygons, double grid) -> Coverage {
  constexpr double most_cells = 250'000;
  geometry::Box2 box;
  for (const auto& polygon : polygons)
    for (const auto p : polygon.outer) box.add(p);
  if (box.empty()) return {};
  const Point2 extent = box.most - box.least;
  grid = std::max(grid, std::sqrt(extent.x * extent.y / most_cells));
  const double x0 = std::ceil(box.least.x / grid) * grid, y0 = std::ceil(box.least.y / grid) * grid;
  Empty empty;
  empty.columns = static_cast<std::size_t>(std::max(0.0, std::floor((box.most.x - x0) / grid) + 1));
  empty.rows = static_cast<std::size_t>(std::max(0.0, std::floor((box.most.y - y0) / grid) + 1));
  empty.cells.resize(empty.columns * empty.rows);
  std::size_t all = 0, missing = 0;
  for (std::size_t row = 0; row < empty.rows; ++row)
    for (std::size_t column = 0; column < empty.columns; ++column) {
      const Point2 p{x0 + grid * static_cast<double>(column), y0 + grid * static_cast<double>(row)};
      if (!geometry::contains(polygons, p)) continue;
      ++all;
      if (mesh.top(p)) continue;
      ++missing;
      empty.cells[row * empty.columns + column] = true;
    }
  if (missing == 0) return {};
  return {static_cast<double>(missing) / static_cast<double>(all),
          std::max(0.0, std::sqrt(widest(empty)) - 0.5) * grid};
}

void set_reasons(model::Attributes& attributes, const std::vector<base::Diagnostic>& reasons) {
  std::erase_if(attributes, [](const auto& one) { return one.first == "ms_reasons"; });
  if (reasons.empty()) return;
  std::string words;
  for (const auto& reason : reasons) words += (words.empty() ? "" : "; ") + reason.message;
  auto at = attributes.end();
  for (const char* last : {"ms_error", "ms_checks", "ms_quality"}) {
    at = std::ranges::find(attributes, last, &model::Attributes::value_type::first);
    if (at != attributes.end()) break;
  }
  if (at != attributes.end()) ++at;
  attributes.emplace(at, "ms_reasons", std::move(words));
}

auto failed_checks(std::string_view outcome, const model::Attributes& levels, std::string_view ground_source)
    -> std::vector<std::string_view> {
  constexpr double half = 0.5;
  bool valid = true, covered = true;
  for (const auto& [name, value] : levels) {
    const bool validity = std::ranges::any_of(level_names(), [&](const auto& names) { return name == names.val3dity; });
    if (validity) valid = valid && value == model::Value(std::string("[]"));
    if (const auto* share = std::get_if<double>(&value); share != nullptr && name == "ms_nodata_share")
      covered = covered && *share <= half;
  }
  std::vector<std::string_view> out;
  if (outcome != "full") out.emplace_back("outcome");
  if (!valid) out.emplace_back("validity");
  if (!covered) out.emplace_back("coverage");
  if (ground_source == "assumed" || ground_source == "lowest") out.emplace_back("ground");
  return out;
}

void add_quality(std::string_view outcome, const std::vector<std::string_view>& failed,
                 const std::optional<confidence::Confidence>& confidence, model::Attributes& attributes) {
  if (outcome == "refused" || outcome == "covered") {
    attributes.emplace_back("ms_quality", "none");
    return;
  }
  std::string_view quality = confidence ? confidence::class_of(confidence->right) : "unknown";
  if (quality == "high" && !failed.empty()) quality = "medium";
  attributes.emplace_back("ms_quality", std::string(quality));
  std::string words = failed.empty() ? "no check failed" : "failed: ";
  for (const auto check : failed) words += (check == failed.front() ? "" : ", ") + std::string(check);
  attributes.emplace_back("ms_checks", words);
  if (!confidence) return;
  constexpr double hundredths = 100;
  attributes.emplace_back("ms_confidence", std::round(confidence->right * hundredths) / hundredths);
  attributes.emplace_back("ms_error", std::round(confidence->error * hundredths) / hundredths);
}

}  // namespace mansard::report
