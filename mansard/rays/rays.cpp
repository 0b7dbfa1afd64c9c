#include "mansard/rays/rays.hpp"

#include <embree3/rtcore.h>

namespace mansard::rays {

using geometry::Point2;
using geometry::Point3;

struct Scene::Parts {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Point3 centre;
  double top = 0;  ///< a z above everything, relative to the centre
  bool empty = true;

  Parts() = default;
  Parts(const Parts&) = delete;
  auto operator=(const Parts&) -> Parts& = delete;
  ~Parts() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

Scene::Scene(const geometry::Mesh& mesh) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.empty = mesh.triangles.empty();
  if (p.empty) return;

  constexpr double far = std::numeric_limits<double>::infinity();
  Point3 least{far, far, far}, most{-far, -far, -far};
  for (const Point3& v : mesh.vertices) {
    least = {std::min(least.x, v.x), std::min(least.y, v.y), std::min(least.z, v.z)};
    most = {std::max(most.x, v.x), std::max(most.y, v.y), std::max(most.z, v.z)};
  }
  p.centre = 0.5 * (least + most);
  p.top = most.z - p.centre.z + 1;

  // One builder thread: the tree, and so which of two equally near triangles is hit, is the same every time.
  p.device = rtcNewDevice("threads=1,set_affinity=0");
  p.scene = rtcNewScene(p.device);
  rtcSetSceneFlags(p.scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry triangles = rtcNewGeometry(p.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.triangles.size()));
  for (const Point3& v : mesh.vertices) {
    *vertices++ = static_cast<float>(v.x - p.centre.x);
    *vertices++ = static_cast<float>(v.y - p.centre.y);
    *vertices++ = static_cast<float>(v.z - p.centre.z);
  }
  for (const auto& t : mesh.triangles)
    for (const auto corner : t) *indices++ = corner;
  rtcCommitGeometry(triangles);
  rtcAttachGeometry(p.scene, triangles);
  rtcReleaseGeometry(triangles);
  rtcCommitScene(p.scene);
}

Scene::Scene(Scene&&) noexcept = default;
auto Scene::operator=(Scene&&) noexcept -> Scene& = default;
Scene::~Scene() = default;

auto Scene::cast(Point3 origin, Point3 direction) const -> std::optional<Hit> {
  if (parts_->empty) return std::nullopt;
  const Point3 o = origin - parts_->centre;
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
  rtcIntersect1(parts_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.ray.tfar, query.hit.primID};
}

auto Scene::seen_from_above(Point2 at) const -> std::optional<Seen> {
  if (parts_->empty) return std::nullopt;
  const double z = parts_->centre.z + parts_->top;
  const auto hit = cast({at.x, at.y, z}, {0, 0, -1});
  if (!hit) return std::nullopt;
  return Seen{z - hit->distance, hit->triangle};
}

auto Scene::top(Point2 at) const -> std::optional<double> {
  const auto seen = seen_from_above(at);
  return seen ? std::optional(seen->z) : std::nullopt;
}

}  // namespace mansard::rays
