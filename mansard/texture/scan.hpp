// A textured scan around buildings: its triangles in a file on disk, its images decoded when they are needed.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/textured_mesh.hpp"
#include "mansard/model/texture.hpp"
#include "mansard/texture/points.hpp"

namespace mansard::texture {

using formats::no_material;

/// A triangle of the scan with what colours it.
struct ScanTriangle {
  std::array<geometry::Point3, 3> corners;
  std::array<std::array<float, 2>, 3> uv{};
  std::array<formats::LinearColour, 3> colour{};
  std::uint16_t unused = 0;
  std::uint32_t material = no_material;
};

/// The colour at a point of a triangle, sRGB; `pixels` is the picture of its material. None where that is missing.
[[nodiscard]] auto colour_at(const ScanTriangle& triangle, geometry::Point3 p, const model::Pixels* pixels,
                             const std::array<formats::Wrap, 2>& wrap) -> std::optional<std::array<std::uint8_t, 3>>;

/// First `expect` for every building, then `add` for every mesh, then the rest. Memory: what lists the cells, and the
/// images up to a bound.
class Scan {
 public:
  /// `image_memory` in MB. Fails with "file-write".
  [[nodiscard]] static auto open(double image_memory) -> base::Result<std::unique_ptr<Scan>>;

  /// Triangles that reach into this box, and into those of other calls, are kept; all others are not.
  void expect(const geometry::Box3& box);
  /// Of all that is expected.
  [[nodiscard]] auto expected() const -> const geometry::Box2& { return expected_; }
  /// In the frame of the buildings. Triangles without a picture and without a colour of their own are left out.
  void add(const formats::TexturedMesh& mesh);
  /// The points of a coloured cloud, likewise.
  void add(const std::vector<ScanPoint>& points);
  [[nodiscard]] auto empty() const -> bool { return cells_.empty() && large_.empty() && points_of_.empty(); }
  [[nodiscard]] auto has_points() const -> bool { return !points_of_.empty(); }

  /// The triangles that reach into the box, each once, in an order that depends on nothing but them. Fails with
  /// "file-write". From one thread at a time.
  [[nodiscard]] auto near(const geometry::Box3& box) const -> base::Result<std::vector<ScanTriangle>>;

  /// The points in the box, in no order. Fails with "file-write". From one thread at a time.
  [[nodiscard]] auto points_near(const geometry::Box3& box) const -> base::Result<std::vector<ScanPoint>>;

  /// The picture of a material, decoded; none where it is missing or cannot be read. From any thread.
  [[nodiscard]] auto image(std::uint32_t material) const -> std::shared_ptr<const model::Pixels>;
  [[nodiscard]] auto wrap(std::uint32_t material) const -> const std::array<formats::Wrap, 2>&;

  /// Pictures that are missing ("texture-missing") or cannot be read ("texture-image"), once each, by name; and that
  /// there was nothing coloured ("texture-none").
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic>;

 private:
  using Cell = std::pair<std::int32_t, std::int32_t>;
  struct Chunk {
    std::uint64_t offset = 0;
    std::size_t triangles = 0;  ///< or points
  };
  struct Material {
    formats::ImageSource source;  ///< without bytes
    std::array<formats::Wrap, 2> wrap{};
    std::uint32_t image = 0;  ///< materials with the same picture have the same
  };
  struct Image {
    std::string path;
    std::string name;
    std::uint64_t offset = 0;
    std::size_t bytes = 0;  ///< in the file of images; 0: in a file of its own
    bool embedded = false;
    std::optional<base::Diagnostic> refused{};
  };
  struct Decoded {
    std::shared_ptr<const model::Pixels> pixels;
    std::list<std::uint32_t>::iterator use;
  };

  explicit Scan(double image_memory) : most_bytes_(static_cast<std::size_t>(image_memory * 1e6)) {}
  auto number_of(const formats::TextureMaterial& material) -> std::uint32_t;
  [[nodiscard]] auto decode(const Image& image) const -> base::Result<model::Pixels>;
  void append(std::vector<Chunk>& chunks, const std::vector<ScanTriangle>& triangles);

  std::size_t most_bytes_;
  geometry::Box2 expected_;
  std::set<Cell> wanted_;
  std::unique_ptr<base::Spool> triangles_, pictures_, points_;
  std::map<Cell, std::vector<Chunk>> cells_, points_of_;
  std::vector<Chunk> large_;  ///< triangles that reach into many cells
  std::vector<Material> materials_;
  std::vector<Image> images_;
  std::map<std::string, std::uint32_t> image_of_path_;

  mutable std::mutex mutex_;
  mutable std::map<std::uint32_t, Decoded> decoded_;
  mutable std::list<std::uint32_t> used_;  ///< the last one first
  mutable std::size_t bytes_ = 0;
  mutable std::map<std::string, base::Diagnostic> failed_;
};

}  // namespace mansard::texture
