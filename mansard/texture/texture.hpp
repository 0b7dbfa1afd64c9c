// The pictures of a textured scan on the faces of building models.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/model/city.hpp"
#include "mansard/texture/options.hpp"
#include "mansard/texture/scan.hpp"

namespace mansard::texture {

/// The pictures of the faces of the solids of one building. Every face has a rectangle in its plane, with the eave or
/// the horizontal along its lower side, of square texels. A texel is the mean, in linear light, of the scan's surface
/// at `samples`² places: of the triangles that face as the face does within `angle`, the nearest along the normal
/// between `outward` and `inward`. Texels without are continued from the rest of the face where at least `fill_share`
/// of it is known, else they have the mean colour of this building's roofs or walls; a face of which nothing is known
/// is one pixel. `side`: pixels along an image at most; faces that are longer have larger texels. Guarantees: 1 the
/// pixels depend on nothing but the solids and the scan near them: neither on other buildings, nor on the origin of the
/// frame, nor on the number of threads · 2 a texel that is known shows the scan's surface within the tolerances · 3
/// there are as many solids and faces as given. Cost: linear in the texels and in the triangles near each face. Fails
/// with "file-write" where the scan cannot be read back.
[[nodiscard]] auto bake(const std::vector<model::LabelledSolid>& solids, const Scan& scan, const Options& options,
                        std::uint32_t side) -> base::Result<model::BuildingTexture>;

/// The share of the known area, as an attribute of the building.
inline constexpr const char* known_attribute = "ms_texture_known";

/// The textures of all buildings of a run, in a file without a name.
class PutAside {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open() -> base::Result<std::unique_ptr<PutAside>>;
  /// Bakes those of the next building, for its solids as they are written. Fails as bake.
  [[nodiscard]] auto add(const model::Building& building, const Scan& scan, const Options& options,
                         const formats::WriteOptions& write) -> base::Result<void>;
  /// Gives the building that was added as that number its textures, and the share that is known as an attribute; does
  /// nothing for one without solids. Fails with "file-write".
  [[nodiscard]] auto apply(std::size_t number, model::Building& building) const -> base::Result<void>;

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  std::unique_ptr<base::Spool> spool_;
  std::vector<Place> places_;
};

/// Reads the textured meshes around buildings, whose boxes the scan expects, into it. Warns as Scan::warnings. Fails as
/// ingest::read_textured.
[[nodiscard]] auto read(Scan& scan, const std::vector<std::filesystem::path>& meshes, const ingest::Options& options,
                        const model::Frame& frame, const base::Run& run = {})
    -> base::Result<std::vector<base::Diagnostic>>;

/// Calls the function with every building of a run, in order, and ends with its first failure.
using EachBuilding =
    std::function<base::Result<void>(const std::function<base::Result<void>(const model::Building&)>&)>;

struct Baked {
  std::unique_ptr<Scan> scan;
  std::unique_ptr<PutAside> textures;
  std::vector<base::Diagnostic> warnings;
};
/// All of it for a run: the boxes of the buildings, the scan around them, the textures of each. `each` is called twice.
/// Fails as the others here, with "cancelled", and as `each`.
[[nodiscard]] auto bake_all(const EachBuilding& each, const std::vector<std::filesystem::path>& meshes,
                            const ingest::Options& ingest, const model::Frame& frame, const Options& options,
                            const formats::WriteOptions& write, const base::Run& run = {}) -> base::Result<Baked>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::texture
