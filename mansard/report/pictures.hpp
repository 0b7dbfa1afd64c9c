// Pictures of a run's result.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

#include "mansard/evaluate/merged.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/report/report.hpp"
#include "mansard/texture/scan.hpp"

namespace mansard::report {

/// Figure 5 of the paper, twice: the scan with the footprints beside the models, from above and at an angle; and the
/// vertical error on a scale of ±`limit` metres.
struct Pictures {
  picture::Image above, angle, error;
};
/// With `textured`, scan and models have their textures.
struct TexturedLayers {
  picture::Layer scan, models;
};

/// Where the buildings are, with some street around them: what the pictures show.
[[nodiscard]] auto frame_of(const model::Scene& scene) -> geometry::Box2;
/// How many triangles of a scene with so many are drawn at a time. A small scene is quicker as one piece, which is
/// prepared for rays once; of a large one a piece takes a small part of the memory of the run. Pieces that are too many
/// are slow, since every ray is compared with the box of each.
[[nodiscard]] constexpr auto piece_triangles(std::size_t all) -> std::size_t {
  constexpr std::size_t small = 600'000, least = 200'000, most_pieces = 128;
  return all <= small ? small : std::max(least, all / most_pieces);
}

/// A mesh of which one piece is in memory at a time; each triangle is in one of them.
struct ScanPieces {
  std::size_t count = 0;
  std::function<base::Result<std::shared_ptr<const geometry::Mesh>>(std::size_t piece)> load;
};
/// What a run read and made, for pictures in memory that does not grow with it but for its footprints.
struct Drawn {
  const model::Scene& scene;  ///< its mesh is not used
  ScanPieces scan;            ///< within frame_of(scene); at most piece_triangles(all) each, where possible
  using Visit = std::function<base::Result<void>(const model::Building&)>;
  std::function<base::Result<void>(const Visit&)> each_building;
  evaluate::EachMap each_error_map;
};
/// Fails as the parts of `drawn` do, and with "file-write" where something could not be put aside.
[[nodiscard]] auto pictures(const Drawn& drawn, double limit, const base::Run& run = {},
                            const TexturedLayers* textured = nullptr) -> base::Result<Pictures>;
/// Of what is in memory.
[[nodiscard]] auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit,
                            const base::Run& run = {}) -> base::Result<Pictures>;

/// The solids of buildings as they are written, with their textures; the city must outlive it. Faces without have the
/// colour of their class.
[[nodiscard]] auto textured_models(const model::City& city, formats::Solids solids) -> picture::Layer;
/// The scan near the buildings; its images are in memory for as long as the layer is. Fails as texture::Scan::near.
[[nodiscard]] auto textured_scan(const texture::Scan& scan, const model::Scene& scene) -> base::Result<picture::Layer>;

/// A building close by, from two sides: on the left the scan with the footprint, on the right the model in its street.
/// Without a scan the model alone, or where it has none, the scan. The side of the first row is that of its longest
/// wall. Fails as picture::draw_views does; nothing where there is neither.
struct CloseUp {
  const model::Building& building;       ///< with its models, in a frame
  const geometry::Mesh* scan = nullptr;  ///< around it, in that frame; null: none
};
inline constexpr double close_up_margin = 4;  ///< m; of the scan around a building
[[nodiscard]] auto close_up(const CloseUp& shown, std::size_t panel_width, std::size_t panel_height,
                            const base::Run& run = {}) -> std::optional<picture::Image>;

/// The models alone.
[[nodiscard]] auto picture_of(const model::City& city, const picture::View& view = {}, const base::Run& run = {})
    -> picture::Image;

}  // namespace mansard::report
