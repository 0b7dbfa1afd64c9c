#include "mansard/rays/rays.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <mutex>
#include <new>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "mansard/geometry/mesh_part.hpp"
#include "mansard/rays/detail/from_above.hpp"

namespace mansard::rays {

using geometry::Point2;
using geometry::Point3;

namespace {

/// The point of the triangle a, b, c nearest to p: a corner, else on an edge, else inside, by the signs of p's
/// coordinates along the edges (C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
auto nearest_point(Point3 p, Point3 a, Point3 b, Point3 c) -> Point3 {
  const Point3 ab = b - a, ac = c - a;
  const double a_b = dot(ab, p - a), a_c = dot(ac, p - a);
  if (a_b <= 0 && a_c <= 0) return a;
  const double b_b = dot(ab, p - b), b_c = dot(ac, p - b);
  if (b_b >= 0 && b_c <= b_b) return b;
  const double beyond_ab = a_b * b_c - b_b * a_c;
  if (beyond_ab <= 0 && a_b >= 0 && b_b <= 0) return a + (a_b / (a_b - b_b)) * ab;
  const double c_b = dot(ab, p - c), c_c = dot(ac, p - c);
  if (c_c >= 0 && c_b <= c_c) return c;
  const double beyond_ac = c_b * a_c - a_b * c_c;
  if (beyond_ac <= 0 && a_c >= 0 && c_c <= 0) return a + (a_c / (a_c - c_c)) * ac;
  const double beyond_bc = b_b * c_c - c_b * b_c;
  const double to_c = b_c - b_b, to_b = c_b - c_c;
  if (beyond_bc <= 0 && to_c >= 0 && to_b >= 0) return b + (to_c / (to_c + to_b)) * (c - b);
  const double whole = beyond_ab + beyond_ac + beyond_bc;
  return a + (beyond_ac / whole) * ab + (beyond_ab / whole) * ac;
}

/// Error bound, relative, of a distance that Embree computes in floats, v = 2⁻²⁴: three differences, squares and sums
/// and a root are 1 + 1 + 1 + 2 over 2 + 1 v, less than 5 v; and 1 v for the radius. 1e-6 is 16 v.
constexpr double distance_error = 1e-6;
/// Error bound, per metre of |x| + |y| + |z| from the centre: the place searched from is rounded to floats, 1 v of each
/// coordinate. Twice that.
constexpr double place_error = 0x1.0p-23;

/// What a search for the nearest place knows while it goes through the tree.
struct Search {
  const float* vertices = nullptr;
  const unsigned* indices = nullptr;
  Point3 to;
  double within = 0;
  const Scene::Extra* extra = nullptr;
  double slack = 0;  ///< m; Embree's distances may be greater than they are by this and `distance_error`
  bool found = false;
  double cost = 0;
  Nearest best;

  /// A radius within which Embree finds whatever is within `distance`.
  [[nodiscard]] auto radius_for(double distance) const -> double { return (distance + slack) * (1 + distance_error); }
  [[nodiscard]] auto corner(unsigned triangle, unsigned k) const -> Point3 {
    const float* v = vertices + 3 * std::size_t{indices[3 * std::size_t{triangle} + k]};
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  }
};

/// Called for every triangle of a leaf; true where the search has become narrower.
auto look_at(RTCPointQueryFunctionArguments* at) -> bool {
  auto& search = *static_cast<Search*>(at->userPtr);
  const unsigned t = at->primID;
  const double extra = search.extra != nullptr ? (*search.extra)(t) : 0;
  if (search.found && extra > search.cost) return false;
  const Point3 place = nearest_point(search.to, search.corner(t, 0), search.corner(t, 1), search.corner(t, 2));
  const double distance = length(place - search.to), cost = distance + extra;
  if (distance > search.within || !(cost < std::numeric_limits<double>::infinity())) return false;
  if (search.found && (cost > search.cost || (cost == search.cost && t > search.best.triangle))) return false;
  search.found = true;
  search.cost = cost;
  search.best = {place, distance, t};
  // More than the best by what rounding may add to a distance, so that what is as near or nearer is still considered.
  const auto radius = static_cast<float>(search.radius_for(cost));
  if (!(radius < at->query->radius)) return false;
  at->query->radius = radius;
  return true;
}

/// m: four times the root mean square of the waves that scanned walls have (0.06 and 0.06 m: `oblique-aerial` in
/// docs/simulate.md). What juts out farther is a balcony, or eaves.
constexpr double bulge_reach = 0.35;
/// m: over a lower step a wall has no room for a wave that could be told from the roof's edge.
constexpr double least_wall = 1;
/// m: what is lower is no roof above the ground, and what differs by less may be one roof.
constexpr double least_storey = 2;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// The mesh as Embree has it.
struct Tree {
  Owned<RTCDevice> device;
  Owned<RTCScene> scene;
  const float* vertices = nullptr;  ///< as Embree keeps them
  const unsigned* indices = nullptr;
  Point3 centre;

  explicit Tree(const geometry::Mesh& mesh);
};

/// Embree returns nothing, or sets an error code, where memory runs out. With other errors there is no tree either.
void check(RTCDevice device, const void* made) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY || (made == nullptr && error == RTC_ERROR_NONE)) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree error " + std::to_string(error));
}

Tree::Tree(const geometry::Mesh& mesh) {
  const auto box = geometry::Box3::of(mesh.vertices);
  centre = 0.5 * (box.least + box.most);

  // One builder thread: the tree, and so which of two equally near triangles is hit, is the same every time. No
  // configuration files of the machine. Tests add "isa=…" to compute as another processor would.
  const char* more = std::getenv("MANSARD_EMBREE");
  const std::string config = "threads=1,set_affinity=0,ignore_config_files=1";
  device.reset(rtcNewDevice((more != nullptr ? config + "," + more : config).c_str()));
  check(device.get(), device.get());
  scene.reset(rtcNewScene(device.get()));
  check(device.get(), scene.get());
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  const Owned<RTCGeometry> triangles(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  check(device.get(), triangles.get());
  auto* to_vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      triangles.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
  check(device.get(), to_vertices);
  auto* to_indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      triangles.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
  check(device.get(), to_indices);
  vertices = to_vertices;
  indices = to_indices;
  for (const Point3& v : mesh.vertices) {
    *to_vertices++ = static_cast<float>(v.x - centre.x);
    *to_vertices++ = static_cast<float>(v.y - centre.y);
    *to_vertices++ = static_cast<float>(v.z - centre.z);
  }
  for (const auto& t : mesh.triangles)
    for (const auto corner : t) *to_indices++ = corner;
  rtcCommitGeometry(triangles.get());
  rtcAttachGeometry(scene.get(), triangles.get());
  rtcCommitScene(scene.get());
  check(device.get(), scene.get());
}

}  // namespace

/// Each structure is built when it is first needed: most scenes are only looked at from above.
struct Scene::Parts {
  geometry::Mesh mesh;
  std::vector<std::uint32_t> hiding;  ///< of the mesh, ascending
  std::once_flag tree_once, above_once, points_once;
  std::unique_ptr<const Tree> tree_;
  std::unique_ptr<const detail::FromAbove> above_;
  std::vector<Point3> points_;

  Parts(geometry::Mesh of, std::vector<std::uint32_t> without) : mesh(std::move(of)), hiding(std::move(without)) {}
  [[nodiscard]] auto empty() const -> bool { return mesh.triangles.size() == hiding.size(); }
  [[nodiscard]] auto hides(std::uint32_t triangle) const -> bool {
    return std::ranges::binary_search(hiding, triangle);
  }
  auto tree() -> const Tree& {
    std::call_once(tree_once, [&] {
      if (hiding.empty()) tree_ = std::make_unique<const Tree>(mesh);
      else tree_ = std::make_unique<const Tree>(geometry::without(mesh, hiding));
    });
    return *tree_;
  }
  auto above() -> const detail::FromAbove& {
    std::call_once(above_once, [&] { above_ = std::make_unique<const detail::FromAbove>(mesh); });
    return *above_;
  }
  auto points() -> const std::vector<Point3>& {
    std::call_once(points_once, [&] {
      points_ = mesh.points;
      if (!hiding.empty())
        std::erase_if(points_, [&](Point3 p) {
          const auto seen = above()(xy(p));
          return seen && hides(seen->triangle);
        });
      std::ranges::sort(points_);
    });
    return points_;
  }
};

Scene::Scene(geometry::Mesh mesh) : Scene(std::move(mesh), {}) {}
Scene::Scene(geometry::Mesh mesh, std::vector<std::uint32_t> hiding)
    : parts_(std::make_unique<Parts>(std::move(mesh), std::move(hiding))) {}
Scene::Scene(Scene&&) noexcept = default;
auto Scene::operator=(Scene&&) noexcept -> Scene& = default;
Scene::~Scene() = default;

auto Scene::cast(Point3 origin, Point3 direction) const -> std::optional<Hit> {
  if (parts_->empty()) return std::nullopt;
  const Tree& tree = parts_->tree();
  const Point3 o = origin - tree.centre;
  const Point3 d = geometry::normalised(direction);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(o.x);
  query.ray.org_y = static_cast<float>(o.y);
  query.ray.org_z = static_cast<float>(o.z);
  query.ray.dir_x = static_cast<float>(d.x);
  query.ray.dir_y = static_cast<float>(d.y);
  query.ray.dir_z = static_cast<float>(d.z);
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(tree.scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.ray.tfar, query.hit.primID};
}

namespace {

constexpr std::size_t together = 8;  ///< rays in a packet

/// Rays `first` and the seven after it, as far as there are so many, as Embree wants them.
void fill(RTCRay8& packet, std::array<int, together>& valid, std::span<const Ray> rays, std::size_t first,
          Point3 centre) {
  for (std::size_t k = 0; k < together; ++k) {
    valid[k] = first + k < rays.size() ? -1 : 0;
    const Ray& ray = rays[std::min(first + k, rays.size() - 1)];
    const Point3 o = ray.origin - centre, d = geometry::normalised(ray.direction);
    packet.org_x[k] = static_cast<float>(o.x);
    packet.org_y[k] = static_cast<float>(o.y);
    packet.org_z[k] = static_cast<float>(o.z);
    packet.dir_x[k] = static_cast<float>(d.x);
    packet.dir_y[k] = static_cast<float>(d.y);
    packet.dir_z[k] = static_cast<float>(d.z);
    packet.tnear[k] = packet.time[k] = 0;
    packet.tfar[k] = std::numeric_limits<float>::infinity();
    packet.mask[k] = ~0U;
    packet.id[k] = packet.flags[k] = 0;
  }
}

/// For every packet of so many rays cast(valid, context, number of its first ray), which fills and casts it, then
/// take(place in the packet, number of the ray) for each ray in it.
template <class Cast, class Take>
void each_packet(std::size_t count, Cast cast, Take take) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(4 * together) std::array<int, together> valid{};
  for (std::size_t first = 0; first < count; first += together) {
    cast(valid, context, first);
    for (std::size_t k = 0; k < together && first + k < count; ++k) take(k, first + k);
  }
}

}  // namespace

void Scene::cast_all(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  if (parts_->empty()) {
    std::ranges::fill(hits, std::nullopt);
    return;
  }
  const Tree& tree = parts_->tree();
  RTCRayHit8 packet;
  each_packet(
      rays.size(),
      [&](auto& valid, auto& context, std::size_t first) {
        fill(packet.ray, valid, rays, first, tree.centre);
        std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect8(valid.data(), tree.scene.get(), &context, &packet);
      },
      [&](std::size_t k, std::size_t number) {
        hits[number] = packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                           ? std::nullopt
                           : std::optional(Hit{packet.ray.tfar[k], packet.hit.primID[k]});
      });
}

void Scene::cast_any(std::span<const Ray> rays, std::span<char> blocked) const {
  if (parts_->empty()) {
    std::ranges::fill(blocked, 0);
    return;
  }
  const Tree& tree = parts_->tree();
  RTCRay8 packet;
  each_packet(
      rays.size(),
      [&](auto& valid, auto& context, std::size_t first) {
        fill(packet, valid, rays, first, tree.centre);
        rtcOccluded8(valid.data(), tree.scene.get(), &context, &packet);
      },
      // Embree marks a ray that met something by a length of minus infinity.
      [&](std::size_t k, std::size_t number) { blocked[number] = packet.tfar[k] < 0 ? 1 : 0; });
}

auto Scene::seen_from_above(Point2 at) const -> std::optional<Seen> {
  if (parts_->empty()) return std::nullopt;
  const auto seen = parts_->above()(at);
  return seen && !parts_->hides(seen->triangle) ? std::optional(Seen{seen->z, seen->triangle}) : std::nullopt;
}

auto Scene::top(Point2 at) const -> std::optional<double> {
  const auto seen = seen_from_above(at);
  return seen ? std::optional(seen->z) : std::nullopt;
}

auto Scene::top_inside_walls(Point2 at, double ground) const -> std::optional<double> {
  thread_local std::vector<detail::FromAbove::Crossing> crossings;
  parts_->above().crossings(at, crossings);
  if (crossings.empty() || parts_->hides(crossings.front().triangle)) return std::nullopt;
  const double top = crossings.front().z, foot = crossings.back().z;
  if (crossings.size() < 3 || crossings.size() % 2 == 0 || foot - ground < least_storey || top - foot < least_wall)
    return top;
  double filled = 0;
  for (std::size_t k = 1; k < crossings.size(); ++k) {
    if (crossings[k].upward == crossings[k - 1].upward || parts_->hides(crossings[k].triangle)) return top;
    if (k % 2 == 1) filled += crossings[k - 1].z - crossings[k].z;
  }
  if (2 * filled >= top - foot) return top;
  constexpr double diagonal = std::numbers::sqrt2 / 2;
  for (const Point2 way : {Point2{1, 0},
                           {diagonal, diagonal},
                           {0, 1},
                           {-diagonal, diagonal},
                           {-1, 0},
                           {-diagonal, -diagonal},
                           {0, -1},
                           {diagonal, -diagonal}})
    if (const auto beside = this->top(at + bulge_reach * way); beside && *beside < foot + least_storey) return foot;
  return top;
}

auto Scene::points_in(const geometry::Box2& box) const -> std::vector<Point3> {
  std::vector<Point3> out;
  if (!has_points()) return out;
  const auto& all = parts_->points();
  const auto first = std::ranges::lower_bound(all, box.least.x, {}, &Point3::x);
  const auto last = std::ranges::upper_bound(first, all.end(), box.most.x, {}, &Point3::x);
  std::copy_if(first, last, std::back_inserter(out), [&](Point3 p) { return box.contains(xy(p)); });
  return out;
}

auto Scene::has_points() const -> bool { return !parts_->mesh.points.empty(); }

void Scene::take_vertices_as_points() {
  auto& mesh = parts_->mesh;
  std::vector<char> hidden(mesh.vertices.size(), 0);
  for (const auto t : parts_->hiding)
    for (const auto v : mesh.triangles[t]) hidden[v] = 1;
  mesh.points.clear();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (hidden[v] == 0) mesh.points.push_back(mesh.vertices[v]);
  std::ranges::sort(mesh.points);
  mesh.points.erase(std::unique(mesh.points.begin(), mesh.points.end()), mesh.points.end());
}

auto Scene::nearest(Point3 to, double within) const -> std::optional<Nearest> { return nearest(to, within, {}); }

auto Scene::nearest(Point3 to, double within, const Extra& extra) const -> std::optional<Nearest> {
  if (parts_->empty()) return std::nullopt;
  const Tree& tree = parts_->tree();
  const Point3 at = to - tree.centre;
  Search search{tree.vertices, tree.indices, at, within, extra ? &extra : nullptr, 0, false, 0, {}};
  search.slack = place_error * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
  RTCPointQuery query{};
  query.x = static_cast<float>(at.x);
  query.y = static_cast<float>(at.y);
  query.z = static_cast<float>(at.z);
  query.radius = static_cast<float>(search.radius_for(within));
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree.scene.get(), &query, &context, &look_at, &search);
  if (!search.found) return std::nullopt;
  search.best.point = search.best.point + tree.centre;
  return search.best;
}

}  // namespace mansard::rays
