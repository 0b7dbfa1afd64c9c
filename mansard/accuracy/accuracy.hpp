// Measures how accurate a scan is: its noise and how far that is correlated, its spacing, how much it rounds edges, how
// much it shows of walls, and where the footprints are beside them.
// References: docs/accuracy.md has the derivations; P. Welch, The use of fast Fourier transform for the estimation of
// power spectra (1967) for equivalent degrees of freedom; E. Wilson, M. Hilferty, The distribution of chi-square
// (1931).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/accuracy.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::accuracy {

/// Each replaces what is measured.
struct Options {
  std::optional<double> noise;                              ///< m
  std::optional<double> correlated_area;                    ///< m²
  std::optional<double> spacing;                            ///< m
  std::optional<double> blur, edge_noise;                   ///< m
  std::optional<double> walls;                              ///< share
  std::optional<double> offset_x, offset_y, offset_spread;  ///< m
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// The accuracy of a scan over some footprints. `scene` is of the same mesh, maybe without the crowns of trees.
/// Guarantees: 1 a function of the mesh and the outline alone, whatever the order of triangles, the thread count and
/// the (whole-metre) frame · 2 a mesh of planes has no noise and no blur · 3 planted noise, correlated area, spacing,
/// blur and offset are measured within 20 %, but for one number in fifty (docs/accuracy.md).
/// Cost: O(vertices + outline's length); places and transects are at most some hundreds.
[[nodiscard]] auto measure(const geometry::Mesh& mesh, const rays::Scene& scene,
                           std::span<const geometry::Polygon> outline, const Options& options = {}) -> model::Accuracy;

/// The same in two steps: noise, correlated area and spacing, which the crowns of trees do not change; and, to add to
/// them, all that is seen along the outline.
[[nodiscard]] auto measure_noise(const geometry::Mesh& mesh, std::span<const geometry::Polygon> outline,
                                 const Options& options = {}) -> model::Accuracy;
[[nodiscard]] auto with_edges(model::Accuracy scan, const geometry::Mesh& mesh, const rays::Scene& scene,
                              std::span<const geometry::Polygon> outline, const Options& options = {})
    -> model::Accuracy;

/// A piece of a scan, and the footprints over it in the same frame. `scene` is of the mesh, which reaches
/// `most_displaced` beyond the outline.
struct Piece {
  const geometry::Mesh* mesh = nullptr;
  const rays::Scene* scene = nullptr;
  std::span<const geometry::Polygon> outline;
};
/// Where footprints are beside a scan.
struct Registration {
  geometry::Point2 offset;               ///< m; what to add to the footprints to bring them to the scan
  double error = 0;                      ///< m; standard error of each coordinate
  double spread = 0;                     ///< m; standard deviation from wall to wall
  std::size_t edges = 0, transects = 0;  ///< what it was measured from
};
/// m; offsets up to this along each axis are found.
inline constexpr double most_displaced = 8;
/// The offset of all footprints together. Walls are looked for along the outlines; where these are beside them, along
/// the outlines moved to where the scan falls most from inside to outside, if that meets significantly more walls. The
/// error counts walls as independent, or pieces where these differ more. None where edges face too few ways.
/// Guarantees: the same whatever the order of pieces and the thread count. Cost: O(vertices + outlines' length).
[[nodiscard]] auto registration(std::span<const Piece> pieces) -> std::optional<Registration>;

/// Noise, correlated area and spacing of a mesh alone, over all of it; `edges` and `transects` are 0.
[[nodiscard]] auto measure_alone(const geometry::Mesh& mesh) -> model::Accuracy;

/// The same of points of single surfaces, seen from above: laser points of roofs.
[[nodiscard]] auto noise_of(std::vector<geometry::Point3> points) -> model::Accuracy;

/// Of several scans, or blocks of one, what they are together: by what each was measured from.
[[nodiscard]] auto combined(std::span<const model::Accuracy> all) -> model::Accuracy;

/// In the terms of the field: a name and a value with its unit each, of what was measured.
[[nodiscard]] auto in_words(const model::Accuracy& scan) -> std::vector<std::pair<std::string, std::string>>;
/// The same as one sentence, without a full stop.
[[nodiscard]] auto in_a_sentence(const model::Accuracy& scan) -> std::string;

}  // namespace mansard::accuracy
