// Buildings as CityJSON 2.0 and CityJSONSeq (https://www.cityjson.org/specs/2.0.1/), and back.
#pragma once

#include "mansard/formats/atlas/texture_folder.hpp"
#include "mansard/formats/cityjson/vertex_pool.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/json/json_item.hpp"

namespace mansard::formats::detail {

/// The extension that declares what is ours, docs/mansard.ext.json: "+mansard" at the root, "+ms_footprint" of
/// buildings, "+ms_plan" of their parts, and "+ms_solid_of" of those whose solid is that of several.
inline constexpr std::string_view extension_name = "Mansard";
inline constexpr std::string_view extension_version = "1.0";
/// Version 0.1 had no extension, and the plan without the '+'.
inline constexpr std::string_view plan_name = "+ms_plan", old_plan_name = plan_name.substr(1);
inline constexpr std::string_view solid_of_name = "+ms_solid_of";
inline constexpr std::string_view footprint_name = "+ms_footprint";

/// A '+' in front is for what an extension declares. A source's own attribute of such a name gets a '_' before it, as
/// does one that has some there already, so that each comes back as it was.
[[nodiscard]] auto undeclared(const std::string& name) -> std::string;
[[nodiscard]] auto from_undeclared(const std::string& name) -> std::string;

/// The texture coordinates of a CityJSON object or feature, and the images that it names.
class TextureVertices {
 public:
  /// Images are numbered as in the folder, or, with `local`, as they are first named.
  TextureVertices(base::Sink& sink, bool local) : sink_(sink), local_(local) {}
  [[nodiscard]] auto index_of(std::array<double, 2> uv) -> std::int64_t;
  [[nodiscard]] auto number_of(std::uint32_t page) -> std::int64_t;
  /// In the order of their numbers.
  [[nodiscard]] auto pages() const -> const std::vector<std::uint32_t>& { return pages_; }
  [[nodiscard]] auto count() const -> std::int64_t { return count_; }

 private:
  base::Sink& sink_;
  bool local_;
  std::vector<std::uint32_t> pages_;
  std::map<std::uint32_t, std::int64_t> numbers_;
  std::int64_t count_ = 0;
};

/// The value of "appearance" up to the texture coordinates, whose list is open: [u,v],[… comes next.
[[nodiscard]] auto appearance_head(const TextureVertices& vertices, const TextureFolder& folder) -> JsonText;

/// What of the options a CityJSON is made by.
struct CityJsonOptions {
  Solids solids = Solids::building;
  Lods lods;
  solid::LevelOptions levels;
  std::string title, date, lineage, contact, email;  ///< metadata; empty: none
};
/// Fails with "option-value".
[[nodiscard]] auto cityjson_options(const WriteOptions& options, Format format) -> base::Result<CityJsonOptions>;

/// The member "CityObjects" and the vertices of a CityJSON object or feature, building by building. Buildings must have
/// passed a Gate.
class CityObjects {
 public:
  /// Objects on lines of that level, or on one line when negative.
  CityObjects(const Header& header, const CityJsonOptions& options, base::Sink& vertices, int level,
              TextureVertices* uv = nullptr)
      : frame_(header.frame),
        solids_(options.solids),
        lods_(options.lods),
        levels_(options.levels),
        level_(level),
        pool_(vertices),
        uv_(uv) {
    json_.begin_object();
  }
  /// Warnings are those of solid::unite.
  void add(const model::Building& building, const Gate::Keyed& keys, std::vector<base::Diagnostic>& warnings,
           const TexturedSolids* textured = nullptr);
  /// What was not taken yet.
  [[nodiscard]] auto take() -> std::string { return json_.take(); }
  [[nodiscard]] auto end() -> std::string;
  [[nodiscard]] auto extent() const -> const Extent& { return pool_.extent(); }

 private:
  /// The surfaces of a solid, at the levels of detail that are written.
  struct Shape {
    std::string key;              ///< of the object that it belongs to
    std::vector<std::string> of;  ///< the keys of the parts in it, where they are not those of that object
    std::vector<Surface> fine;    ///< of LoD 2.2, in any case
    LevelSurfaces levels;
    std::size_t solid = 0;  ///< its number in the atlas
  };
  /// Of LoD 0.
  [[nodiscard]] static auto footprint_of(const model::Building& building, const std::vector<Shape>& shapes)
      -> std::vector<Loops>;
  void append_part(const std::string& key, const model::Part* part, const Shape* shape, const std::string& parent);
  void append_solids(const Shape& shape);
  void append_footprint(const std::vector<Loops>& surfaces);
  void append_solid(std::string_view lod, const std::vector<Surface>& surfaces, std::size_t solid = 0,
                    const TexturedSolids* textured = nullptr);
  void append_texture(const std::vector<Surface>& surfaces, std::size_t solid, const TexturedSolids& textured);
  void append_loops(const Loops& loops);

  const model::Frame frame_;
  const Solids solids_;
  const Lods lods_;
  const solid::LevelOptions levels_;
  const int level_;
  VertexPool pool_;
  TextureVertices* uv_;                       ///< none: without textures
  const TexturedSolids* textured_ = nullptr;  ///< of the building at hand
  JsonText json_;
};

/// A CityJSON object up to the value of "CityObjects", which comes next; its members on lines of that level, or on one
/// line when negative.
[[nodiscard]] auto cityjson_head(const Header& header, const CityJsonOptions& options, const Extent& extent, int level)
    -> JsonText;

/// A building as a CityJSONFeature on one line.
[[nodiscard]] auto cityjson_feature(const model::Building& building, const Gate::Keyed& keys, const Header& header,
                                    const CityJsonOptions& options, std::vector<base::Diagnostic>& warnings,
                                    const TexturedSolids* textured = nullptr, const TextureFolder* folder = nullptr)
    -> std::string;

/// The plans that travel in a CityJSON file as mansard wrote it, without models. Throws a Defect: "write-plan-type",
/// and those of plans.
[[nodiscard]] auto read_cityjson_plans(const Item& file) -> model::City;

}  // namespace mansard::formats::detail
