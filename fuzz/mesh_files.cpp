// Bytes → a mesh file; the first says which format it is taken for. Reading must not throw, must give an error of the
// module's or a mesh that keeps what the public header guarantees.
#include <array>
#include <cmath>
#include <exception>

#include "fuzz/files.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/textured_mesh.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
using fuzz::promise;

void check(const ingest::ScannedMesh& scan) {
  for (const auto v : scan.mesh.vertices)
    promise(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "a coordinate that is not finite");
  for (const auto& t : scan.mesh.triangles)
    promise(std::max({t[0], t[1], t[2]}) < scan.mesh.vertices.size(), "a triangle names no vertex");
  promise(scan.classes.empty() || scan.classes.size() == scan.mesh.triangles.size(), "classes for other triangles");
  promise(!scan.mesh.triangles.empty(), "a mesh without triangles");
  promise(scan.inputs.size() >= 1 && scan.inputs[0].sha256.size() == 64, "an input that is not told");
}

void check(const formats::TexturedMesh& mesh) {
  const bool coloured = mesh.has_colour();
  promise(coloured || mesh.corners.empty() || mesh.mesh.triangles.empty(), "colours of other triangles");
  for (const auto material : mesh.material_of)
    promise(material == formats::no_material || material < mesh.materials.size(), "a triangle names no material");
  promise(!coloured || mesh.material_of.size() == mesh.mesh.triangles.size(), "materials of other triangles");
}

auto codes() -> const std::vector<base::Code>& {
  static const auto all = fuzz::with_common(ingest::codes());
  return all;
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  static const fuzz::Folder folder("mesh");
  static const std::array paths{folder.name("mesh.obj"), folder.name("mesh.ply"), folder.name("mesh.off"),
                                folder.name("mesh.glb"), folder.name("mesh.gltf"), folder.name("mesh"),
                                // What says where the meshes beside it are: these bytes are both.
                                folder.name("placed/metadata.xml")};
  static const auto placed = folder.name("placed/mesh.obj");
  if (size == 0) return 0;
  const std::size_t kind = bytes[0] % paths.size();
  folder.hold({reinterpret_cast<const char*>(bytes) + 1, size - 1});
  ingest::Options options;
  options.up = static_cast<formats::UpAxis>(bytes[0] / paths.size() % 3);
  const model::Frame frame{{0, 0, 0}, kind == 6 ? "EPSG:32631" : ""};
  try {
    const auto scan = ingest::read_mesh({kind == 6 ? placed : paths[kind]}, frame, options);
    if (scan) check(*scan);
    else fuzz::check_error(scan.error(), codes());
    if (kind == 6) return 0;
    const auto textured = formats::read_textured_file(paths[kind], options.up);
    if (textured) check(*textured);
    else fuzz::check_error(textured.error(), codes());
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  return 0;
}
