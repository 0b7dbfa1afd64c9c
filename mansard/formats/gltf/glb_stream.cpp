#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/gltf/glb_bytes.hpp"

namespace mansard::formats::detail {
namespace {

class GlbWriter : public CityWriter {
 public:
  GlbWriter(GlbBytes bytes, base::Sink& sink) : bytes_(std::move(bytes)), sink_(&sink) {}

  auto add(const model::Building& building) -> base::Result<void> override {
    auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    return bytes_.add(building, *std::move(keyed));
  }
  auto finish() -> base::Result<void> override { return bytes_.write(*sink_); }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return bytes_.warnings(); }

 private:
  Gate gate_;
  GlbBytes bytes_;
  base::Sink* sink_;
};

}  // namespace

void append_file_extras(JsonText& json, const Header& header) {
  json.key("crs").text(header.frame.crs).key("origin").begin_array();
  for (const auto metres : header.frame.origin) json.whole(metres);
  json.end_array();
  if (!is_foreign(header)) json.key("header").raw(header_record(header));
}

auto GlbBytes::open(const Header& header, const WriteOptions& options) -> base::Result<GlbBytes> {
  auto file = GltfFile::open(gltf_options(options));
  if (!file) return file.error();
  return GlbBytes(header, options, std::move(*file));
}

auto GlbBytes::write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
    -> base::Result<void> {
  const std::string record = is_foreign(header_) ? std::string() : building_record(building);
  Drawn solids = drawn(building, keys, solids_);
  level_.apply(solids, header_.frame);
  warnings_.insert(warnings_.end(), solids.warnings.begin(), solids.warnings.end());
  // Programs without EXT_structural_metadata, Blender among them, show these as properties of the object. The last of
  // two attributes with one name is kept there.
  JsonText extras;
  append_attributes(extras.begin_object().key("building").text(building.id), building.attributes);
  extras.end_object();
  // Pictures are of the faces of LoD 2.2.
  if (level_.lod != Lod::lod22 || textures_for(building, solids.solids.size()) == nullptr) textured = nullptr;
  for (std::size_t s = 0; s < solids.solids.size(); ++s) {
    const model::Part& part = solids.solids[s].part;
    const auto mesh = part_mesh(part.model, part.id);
    if (!mesh) return mesh.error();
    std::vector<geometry::Point3> normals;
    for (const FaceMesh& face : mesh->faces) normals.push_back(face.normal);
    PartTexture texture;
    if (textured != nullptr) texture = part_texture(*mesh, *textured, textured->first + s);
    file_->add_part(columns_.row(building, building.id, buildings_, &part, part.id), s == 0 ? record : "", *mesh,
                    mesh->vertices, normals, textured != nullptr ? &texture : nullptr);
    file_->end_mesh(part.id, extras.str());
  }
  if (solids.solids.empty())
    file_->add_part(columns_.row(building, building.id, buildings_, nullptr, {}), record, {}, {}, {});
  ++buildings_;
  return {};
}

auto GlbBytes::write(base::Sink& sink) -> base::Result<void> {
  if (auto done = empty(); !done) return done;
  columns_.settle();
  JsonText extras;
  append_file_extras(extras.begin_object(), header_);
  return file_->write(sink, "mansard " + header_.made_by.version, extras.end_object().str(), columns_);
}

auto glb_bytes(const model::City& city, const Keys& keys, Solids solids) -> base::Result<std::string> {
  WriteOptions options;
  options.solids = solids;
  auto bytes = GlbBytes::open({city.frame, city.made_by}, options);
  if (!bytes) return bytes.error();
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    if (auto added = bytes->add(city.buildings[b], {keys.buildings[b], keys.parts[b]}); !added) return added.error();
  base::TextSink sink;
  if (auto written = bytes->write(sink); !written) return written.error();
  return std::move(sink.text);
}

auto glb_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  auto sink = outputs.file(path);
  if (!sink) return sink.error();
  auto level = LevelOf::of(options, Format::glb);
  if (!level) return level.error();
  auto bytes = GlbBytes::open(header, options);
  if (!bytes) return bytes.error();
  bytes->set_level(*level);
  return std::unique_ptr<CityWriter>(std::make_unique<GlbWriter>(std::move(*bytes), **sink));
}

}  // namespace mansard::formats::detail
