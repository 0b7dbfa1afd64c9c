// Pictures of a run's result.
#pragma once

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
[[nodiscard]] auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit,
                            const base::Run& run = {}, const TexturedLayers* textured = nullptr) -> Pictures;

/// The solids of buildings as they are written, with their textures; the city must outlive it. Faces without have the
/// colour of their class.
[[nodiscard]] auto textured_models(const model::City& city, formats::Solids solids) -> picture::Layer;
/// The scan near the buildings; its images are in memory for as long as the layer is. Fails as texture::Scan::near.
[[nodiscard]] auto textured_scan(const texture::Scan& scan, const model::Scene& scene) -> base::Result<picture::Layer>;

/// The models alone.
[[nodiscard]] auto picture_of(const model::City& city, const picture::View& view = {}, const base::Run& run = {})
    -> picture::Image;

}  // namespace mansard::report
