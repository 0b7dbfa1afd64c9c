// Writes a city of any size building by building, and reads one back, in every format.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/outputs.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/formats/levels.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats {

/// How a format is called on the command line ("cityjson", "cityjsonseq", "obj", …), what its files end in (".gpkg"; of
/// tiles, which are a folder, ".3dtiles"), and what it carries, in a sentence.
struct FormatName {
  Format format;
  std::string_view name, ending, meaning;
};
[[nodiscard]] auto formats() -> const std::vector<FormatName>&;
/// By the ending of a name, in any case: ".city.json" before ".json"; a folder, or a name without an ending, and
/// "tileset.json" are tiles. None where no format has it.
[[nodiscard]] auto format_of(const std::filesystem::path& path) -> std::optional<Format>;

/// What a file says before its first building.
struct Header {
  model::Frame frame;
  model::MadeBy made_by;
};

/// What one closed shell of an STL stands for.
enum class Shell : std::uint8_t { part, building, block };

/// The codec of the textures of GLB and 3D Tiles; OBJ and CityJSON always have JPEG.
enum class TextureFormat : std::uint8_t { jpeg, webp };

/// What one solid of a file contains.
enum class Solids : std::uint8_t { building, part };

/// The version of CityGML that is written.
enum class CityGml : std::uint8_t { v2, v3 };

struct WriteOptions {
  std::string lod;                            ///< as lods_of() reads it; empty: default_lods()
  solid::LevelOptions levels;                 ///< what the levels of detail below 2.2 leave out
  std::string attributes = "all";             ///< of buildings: as AttributeChoice::of() reads it
  std::string title, date, lineage, contact;  ///< metadata; empty: none
  Solids solids = Solids::building;           ///< of CityJSON, OBJ, GLB and tiles
  Shell stl_shell = Shell::building;
  bool compress = false;          ///< meshes of glb and tiles: EXT_meshopt_compression and KHR_mesh_quantization
  double tile_triangles = 20000;  ///< of a leaf of a tileset, at most, where one building has not more
  TextureFormat texture_format = TextureFormat::jpeg;
  std::int64_t texture_quality = 85;  ///< 1 to 100
  std::int64_t atlas_size = 4096;     ///< pixels along each side of an image with textures, at most
  bool unlit = false;                 ///< textured materials of glb and tiles: KHR_materials_unlit
  double tiles_height_offset = 0;     ///< m; added to the heights of a tileset
  UpAxis obj_up = UpAxis::z;
  bool obj_local = false;  ///< whether an OBJ has coordinates relative to the frame's origin
  CityGml citygml = CityGml::v3;
};
[[nodiscard]] auto option_list(WriteOptions& options) -> base::OptionList;

/// Takes buildings one after the other. Memory does not grow with their number, but where docs/formats.md says by how
/// much. The same header, options and buildings give the same bytes.
class CityWriter {
 public:
  CityWriter() = default;
  CityWriter(const CityWriter&) = delete;
  auto operator=(const CityWriter&) -> CityWriter& = delete;
  virtual ~CityWriter() = default;
  /// Fails with "write-duplicate-id", "write-model", "write-triangulate" and those of the format; the writer is of
  /// no use then.
  [[nodiscard]] virtual auto add(const model::Building& building) -> base::Result<void> = 0;
  /// After the last one: the files are whole, and take their places with Outputs::commit.
  [[nodiscard]] virtual auto finish() -> base::Result<void> = 0;
  /// What could not be written as asked, but otherwise; complete after finish().
  [[nodiscard]] virtual auto warnings() const -> std::vector<base::Diagnostic> { return {}; }
};

/// A writer of that format at that place. `outputs` must outlive it. `more` are layers for a GeoPackage beside those of
/// the city; other formats leave them out.
[[nodiscard]] auto open_writer(Format format, const std::filesystem::path& path, const Header& header,
                               const WriteOptions& options, base::Outputs& outputs, const std::vector<Layer>& more = {})
    -> base::Result<std::unique_ptr<CityWriter>>;

/// The whole city into an open writer, then finish().
[[nodiscard]] auto write_city(const model::City& city, CityWriter& writer) -> base::Result<void>;

/// What a file has beside its city, and what of that cannot be taken along.
struct Beside {
  std::vector<Layer> layers;
  std::vector<base::Diagnostic> warnings;  ///< "write-layer-left"; the subject is the layer's name
};

/// A file of buildings that mansard wrote, read one after the other, in the order they were written in.
class CityReader {
 public:
  CityReader() = default;
  CityReader(const CityReader&) = delete;
  auto operator=(const CityReader&) -> CityReader& = delete;
  virtual ~CityReader() = default;
  [[nodiscard]] virtual auto header() const -> const Header& = 0;
  /// Whether parts come with their models, as those of CityJSON and CityJSONSeq do that was written with a solid for
  /// each part; of the others they come with plans and attributes, and the models are raised from them again.
  [[nodiscard]] virtual auto has_models() const -> bool = 0;
  /// Whether buildings come with their solids instead, as those of CityJSON and CityJSONSeq do otherwise.
  [[nodiscard]] virtual auto has_solids() const -> bool { return false; }
  /// None after the last one.
  [[nodiscard]] virtual auto next() -> base::Result<std::optional<model::Building>> = 0;
  /// Parts of a file of plans that are at fault, and that its buildings therefore lack: "write-plan-…", whose message
  /// says where. Complete after the last next().
  [[nodiscard]] virtual auto refused() const -> std::vector<base::Diagnostic> { return {}; }
  /// The layers of a GeoPackage that are not of the city's making, for open_writer to take: those of a segmentation,
  /// and what others put in, all in memory. Nothing of other formats. Before the first next(), or after it.
  [[nodiscard]] virtual auto beside() -> base::Result<Beside> { return Beside(); }
};

/// Opens a file, or a folder of tiles, that mansard wrote in any format but STL. Guarantees: writing what was read, its
/// models extruded again where there were none, gives the same bytes in the format it was read from, with the same
/// options. Fails with "write-read-format" (what it is instead), "write-read-plans" (there are no plans in it),
/// "write-plan-…", "file-…".
[[nodiscard]] auto read_city(const std::filesystem::path& path) -> base::Result<std::unique_ptr<CityReader>>;

/// All that a file has. Parts that are at fault are left out and listed in `refused`, if there is one; else they are
/// the failure, one diagnostic for each.
[[nodiscard]] auto read_whole(CityReader& reader, std::vector<base::Diagnostic>* refused = nullptr)
    -> base::Result<model::City>;

}  // namespace mansard::formats
