// A binary glTF being made: meshes with a feature id per part and per surface, and tables of what these are.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/atlas/texture_folder.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/gltf/gltf_mesh.hpp"
#include "mansard/formats/gltf/gltf_table.hpp"

namespace mansard::formats::detail {

using Float3 = std::array<float, 3>;
using Float2 = std::array<float, 2>;

/// Where the vertices of a part are in the images of a file.
struct PartTexture {
  std::vector<Float2> uv;            ///< vertex by vertex
  std::vector<std::uint32_t> pages;  ///< face by face: the number that add_image returned
};
/// Those of a solid in an atlas whose first image has that number. `mesh` is that of the solid, in the local frame.
[[nodiscard]] auto part_texture(const PartMesh& mesh, const TexturedSolids& textured, std::size_t solid) -> PartTexture;

/// How a GLB is written.
struct GltfOptions {
  bool compress = false, unlit = false;
  ImageCodec codec = ImageCodec::jpeg;
  int quality = 85;
};
[[nodiscard]] auto gltf_options(const WriteOptions& options) -> GltfOptions;

/// What is put aside does not stay in memory, but for about 12 bytes a part.
class GltfFile {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open(const GltfOptions& options) -> base::Result<std::unique_ptr<GltfFile>>;

  /// The images of an atlas. Returns the number of the first. Fails with "texture-encode".
  [[nodiscard]] auto add_images(const SolidAtlas& atlas) -> base::Result<std::uint32_t>;

  /// A row of the table of parts, with the record of a building or none. The surfaces of the mesh become rows of the
  /// table of surfaces, and its triangles part of the mesh at hand: its vertices at `places`, its faces with `facing`
  /// as their normals, z up both. Slope and azimuth are those of the mesh's own normals. Either all parts of a file
  /// that have triangles have textures, or none has.
  void add_part(const Row& row, std::string_view record, const PartMesh& mesh, std::span<const geometry::Point3> places,
                std::span<const geometry::Point3> facing, const PartTexture* texture = nullptr);

  /// The mesh at hand becomes a node. `extras` is an object as JSON, or nothing. A mesh without triangles is left out.
  void end_mesh(const std::string& name, std::string_view extras = {});

  /// The box of everything added so far, as it is written: y up. None without vertices.
  [[nodiscard]] auto bounds() const -> const std::optional<std::array<Float3, 2>>& { return bounds_; }

  /// The whole file. Fails with "write-glb-size", "file-write".
  [[nodiscard]] auto write(base::Sink& sink, const std::string& generator, std::string_view extras,
                           const PartColumns& columns) -> base::Result<void>;

 private:
  /// Buffer views of meshes, in their order. Compressed, they come again for every chunk of meshes.
  enum View : std::size_t { position_view, normal_view, part_view, surface_view, index_view, uv_view, view_count };
  struct Mesh {
    std::vector<Float3> positions, normals;
    std::vector<float> part_ids, surface_ids;
    std::vector<Float2> uv;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> indices;  ///< by image and class
    std::uint32_t surfaces = 0, parts = 0;  ///< with vertices; the primitives share one accessor of ids
  };
  struct Spools {
    std::array<std::unique_ptr<base::Spool>, view_count> of_view;
    std::unique_ptr<base::Spool> packed, views, nodes, meshes, accessors, rows, records, classes, slopes, azimuths,
        tables, images;
  };

  GltfFile(const GltfOptions& options, Spools spools)
      : options_(options), compress_(options.compress), spools_(std::move(spools)) {}
  /// Of meshes: one more with textures.
  [[nodiscard]] auto views() const -> std::size_t { return textured_ ? view_count : view_count - 1; }
  /// Of that image and class, numbered as they are first needed; of untextured ones that of the class.
  [[nodiscard]] auto material_number(std::uint32_t image, std::uint32_t kind) -> std::int64_t;
  void append_images(JsonText& json, std::size_t first_view) const;
  void append_view(View view, std::string_view bytes);
  void append_accessor(View view, std::size_t offset, std::size_t count, const std::array<Float3, 2>* bounds);
  void append_primitives(JsonText& json, std::size_t vertex, std::size_t index, const std::array<Float3, 2>& bounds);
  void pack();
  void quantise();
  [[nodiscard]] auto fill_tables(TableBytes& parts, TableBytes& plans, TableBytes& surfaces, const PartColumns& columns)
      -> base::Result<void>;
  void append_extensions(JsonText& json, const TableBytes& parts, const TableBytes& plans, const TableBytes& surfaces,
                         const PartColumns& columns) const;
  void append_materials(JsonText& json) const;
  void append_textured_material(JsonText& json, std::uint32_t image, std::uint32_t kind) const;
  void append_views(JsonText& json) const;
  void append_buffers(JsonText& json, std::uint64_t binary) const;
  /// Bytes of all meshes in the binary chunk.
  [[nodiscard]] auto mesh_bytes() const -> std::uint64_t;

  GltfOptions options_;
  bool compress_, textured_ = false;
  Spools spools_;
  Mesh mesh_;
  std::array<std::string, view_count> chunk_;  ///< of the meshes that are compressed next
  std::size_t chunk_vertices_ = 0, chunk_indices_ = 0, packed_chunks_ = 0;
  std::uint64_t unpacked_bytes_ = 0;
  std::int64_t nodes_ = 0, accessors_ = 0;
  std::uint64_t parts_ = 0, surfaces_ = 0, vertices_ = 0, indices_ = 0;
  std::vector<std::uint32_t> record_ends_{0};
  std::optional<std::array<Float3, 2>> bounds_;
  std::vector<std::uint64_t> image_ends_{0};                        ///< in their spool, padded
  std::vector<std::uint64_t> image_bytes_;                          ///< of each
  std::vector<std::pair<std::uint32_t, std::uint32_t>> materials_;  ///< with textures: image and class
};

}  // namespace mansard::formats::detail
