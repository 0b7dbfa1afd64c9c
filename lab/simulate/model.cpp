// The steps of a model that is truth: its faces as triangles, what of the ground each building takes, and who stands
// wall to wall.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/simulate/detail/party.hpp"
#include "lab/simulate/detail/raising.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;
using model::ModelBuilding;
using model::SurfaceClass;

constexpr double splinter = 0.01;  // m²; what is seen from above of a face that stands nearly upright
constexpr double touch = 0.1;      // m; models of cities gape by less between neighbours

auto class_of(SurfaceClass kind) -> Class {
  switch (kind) {
    case SurfaceClass::wall: return Class::wall;
    case SurfaceClass::roof: return Class::roof;
    case SurfaceClass::ground: return Class::ground;
    case SurfaceClass::other: break;
  }
  return Class::other;
}

template <class Act>
void each_face(const ModelBuilding& building, Act act) {
  for (const auto& part : building.parts)
    for (const auto& face : part.faces) act(face);
}

auto has_ground(const ModelBuilding& building) -> bool {
  bool any = false;
  each_face(building, [&](const auto& face) { any = any || face.kind == SurfaceClass::ground; });
  return any;
}

/// The lowest corner of the ground, or of all where there is none; and the highest corner.
auto heights_of(const ModelBuilding& building, bool of_ground) -> std::pair<double, double> {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  each_face(building, [&](const auto& face) {
    for (const Point3 p : face.loops.front()) {
      if (!of_ground || face.kind == SurfaceClass::ground) low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
  });
  return {low, high};
}

/// A face as it lies in plan; several polygons, or none, where it is seen edge on.
auto in_plan(const model::ModelFace& face) -> std::vector<Polygon> {
  Polygon polygon;
  for (std::size_t l = 0; l < face.loops.size(); ++l) {
    auto& ring = l == 0 ? polygon.outer : polygon.holes.emplace_back();
    for (const Point3 p : face.loops[l]) ring.push_back(xy(p));
  }
  auto valid = geometry::make_valid(geometry::oriented(std::move(polygon)));
  if (!valid) return {};
  std::erase_if(*valid, [](const Polygon& p) { return geometry::area(p) < splinter; });
  return std::move(*valid);
}

/// What of the ground a building takes; empty where that is no polygon.
auto outline_of(const ModelBuilding& building, bool of_ground) -> std::vector<Polygon> {
  std::vector<Polygon> seen;
  each_face(building, [&](const auto& face) {
    if (of_ground ? face.kind != SurfaceClass::ground : face.kind == SurfaceClass::wall) return;
    std::ranges::move(in_plan(face), std::back_inserter(seen));
  });
  auto outline = detail::outline_of(seen);
  return outline ? std::move(*outline) : std::vector<Polygon>();
}

auto standing_of(const ModelBuilding& building, const std::vector<Polygon>& outline) -> detail::Standing {
  detail::Standing out{outline, {}};
  each_face(building, [&](const auto& face) {
    if (face.kind == SurfaceClass::wall) out.walls.push_back(face.loops.front());
  });
  return out;
}

/// The surface of some buildings of a model, one after the other.
class Builder {
 public:
  explicit Builder(const model::Model& model) : all_(model::surface_of(model)) {
    for (const auto face : all_.faces) faces_ = std::max(faces_, face + 1);
  }
  /// Faces that cannot be cut into triangles.
  [[nodiscard]] auto lost() const -> std::size_t { return all_.lost; }

  /// Takes a building's faces as number `number`, turned back where they are inside out.
  void add(std::size_t building, std::uint32_t number) {
    const auto own = std::ranges::equal_range(all_.buildings, static_cast<std::uint32_t>(building));
    const auto from = static_cast<std::size_t>(own.begin() - all_.buildings.begin()), to = from + own.size();
    const bool inside_out = volume(from, to) < 0;
    for (std::size_t t = from; t < to; ++t) {
      auto corners = all_.mesh.triangles[t];
      if (inside_out) std::swap(corners[1], corners[2]);
      take(all_.mesh.vertices[corners[0]], all_.mesh.vertices[corners[1]], all_.mesh.vertices[corners[2]],
           class_of(all_.classes[t]), number, all_.faces[t]);
    }
  }

  /// A floor that looks down; a polygon that cannot be cut into triangles has none.
  void add_floor(const Polygon& polygon, double z, std::uint32_t number) {
    const auto triangles = geometry::triangulate(polygon);
    if (!triangles) return;
    std::vector<Point2> points = polygon.outer;
    for (const auto& hole : polygon.holes) points.insert(points.end(), hole.begin(), hole.end());
    const auto at = [&](std::uint32_t i) { return Point3{points[i].x, points[i].y, z}; };
    for (const auto& t : *triangles) take(at(t[0]), at(t[2]), at(t[1]), Class::ground, number, faces_);
    ++faces_;
  }

  [[nodiscard]] auto surface() && -> Surface { return std::move(out_); }
  [[nodiscard]] auto surface() const& -> const Surface& { return out_; }

 private:
  /// m³, times 6, about a corner of the first triangle.
  [[nodiscard]] auto volume(std::size_t from, std::size_t to) const -> double {
    double sum = 0;
    const auto& mesh = all_.mesh;
    for (std::size_t t = from; t < to; ++t) {
      const Point3 o = mesh.vertices[mesh.triangles[from][0]];
      const auto& [a, b, c] = mesh.triangles[t];
      sum += dot(mesh.vertices[a] - o, cross(mesh.vertices[b] - o, mesh.vertices[c] - o));
    }
    return sum;
  }

  void take(Point3 a, Point3 b, Point3 c, Class kind, std::uint32_t building, std::uint32_t face) {
    const auto first = static_cast<std::uint32_t>(out_.mesh.vertices.size());
    out_.mesh.vertices.insert(out_.mesh.vertices.end(), {a, b, c});
    out_.mesh.triangles.push_back({first, first + 1, first + 2});
    out_.classes.push_back(kind);
    out_.buildings.push_back(building);
    out_.faces.push_back(face);
  }

  model::ModelSurface all_;  // building after building
  std::uint32_t faces_ = 0;
  Surface out_;
};

/// Areas by class, of the triangles from `from` on; and whether what looks up and what looks down are not the same
/// area.
struct Seen {
  std::array<double, class_count> area{};
  bool open = false;
};
auto seen_of(const Surface& surface, std::size_t from) -> Seen {
  Seen seen;
  double up = 0, down = 0;
  for (std::size_t t = from; t < surface.mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = surface.mesh.triangles[t];
    const auto& v = surface.mesh.vertices;
    const Point3 doubled = cross(v[j] - v[i], v[k] - v[i]);
    seen.area[static_cast<std::size_t>(surface.classes[t])] += length(doubled) / 2;
    (doubled.z > 0 ? up : down) += std::abs(doubled.z) / 2;
  }
  constexpr double slack = 0.005;  // of the area; corners are rounded
  seen.open = std::abs(up - down) > slack * std::max(up, down);
  return seen;
}

/// How many, and the first of them.
auto some(const std::vector<std::string>& ids) -> std::string {
  return std::to_string(ids.size()) + (ids.size() == 1 ? " building (" : " buildings (the first: ") + ids.front() + ")";
}

}  // namespace

auto within(model::Model model, const geometry::Box2& box) -> model::Model {
  const geometry::Point2 origin{static_cast<double>(model.frame.origin[0]), static_cast<double>(model.frame.origin[1])};
  std::erase_if(model.buildings, [&](const ModelBuilding& building) {
    geometry::Box2 own;
    each_face(building, [&](const auto& face) {
      for (const Point3 p : face.loops.front()) own.add(xy(p) + origin);
    });
    return !box.overlaps(own);
  });
  return model;
}

auto truth_of(const model::Model& model, std::vector<base::Diagnostic>& warnings) -> base::Result<ModelTruth> {
  const std::string subject = model.inputs.empty() ? std::string() : model.inputs.front().path;
  Truth truth;
  truth.city.frame = model.frame;
  ModelSource source{model.inputs.empty() ? model::InputFile{} : model.inputs.front(), model.lod, {}};
  Builder builder(model);
  std::vector<detail::Standing> standing;
  std::vector<std::string> without_outline, without_ground, open;
  for (std::size_t b = 0; b < model.buildings.size(); ++b) {
    const auto& from = model.buildings[b];
    const bool ground_faces = has_ground(from);
    auto outline = outline_of(from, ground_faces);
    if (outline.empty()) {
      without_outline.push_back(from.id);
      continue;
    }
    const auto number = static_cast<std::uint32_t>(truth.city.buildings.size());
    const auto [ground, top] = heights_of(from, ground_faces);
    const std::size_t first = builder.surface().mesh.triangles.size();
    builder.add(b, number);
    const auto area = seen_of(builder.surface(), first).area;
    if (!ground_faces) {
      without_ground.push_back(from.id);
      for (const auto& polygon : outline) builder.add_floor(polygon, ground, number);
    }
    if (seen_of(builder.surface(), first).open) open.push_back(from.id);
    source.buildings.push_back({top, ground_faces, area});
    standing.push_back(standing_of(from, outline));
    model::Building building;
    building.id = from.id;
    building.footprint = std::move(outline);
    building.ground = ground;
    truth.city.buildings.push_back(std::move(building));
  }
  if (builder.lost() > 0)
    warnings.push_back(base::warning(
        "ingest-model-face", std::to_string(builder.lost()) + " faces cross themselves and were left out", subject));
  const auto say = [&](const std::vector<std::string>& ids, const char* code, const char* what) {
    if (!ids.empty()) warnings.push_back(base::warning(code, some(ids) + what, subject));
  };
  say(without_outline, "simulate-model-outline", " without area from above left out");
  say(without_ground, "simulate-model-ground", " without ground faces: outlined by what is seen from above");
  say(open, "simulate-model-open", " not closed: taken as solid from the highest surface down to the ground");
  if (truth.city.buildings.empty())
    return base::error("simulate-nothing", "no building of the model has an area when seen from above", subject);
  truth.party_walls = detail::party_walls_of(standing, touch);
  truth.model = std::move(source);
  return ModelTruth{std::move(truth), std::move(builder).surface()};
}

}  // namespace mansard::simulate
