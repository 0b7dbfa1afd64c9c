// Buildings as ASCII DXF of AutoCAD release 12 (AC1009), which every program reads: a 3DFACE a triangle, a layer a
// class.
#include <array>

#include "mansard/base/text.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/triangles.hpp"
#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {
namespace {

/// A group code and its value, each on a line.
void group(std::string& out, int code, std::string_view value) {
  out += std::to_string(code);
  out += '\n';
  out += value;
  out += '\n';
}

/// Strings of release 12 are at most 255 bytes on one line.
auto dxf_text(std::string_view text) -> std::string {
  constexpr std::size_t most = 255;
  std::string out(text.substr(0, most));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return out;
}

/// Colours of the AutoCAD Color Index, in the order of model::FaceClass.
constexpr std::array<int, class_count> colours{9, 8, 12, 252, 32};
constexpr std::string_view application = "MANSARD";

auto head() -> std::string {
  std::string out;
  const auto table = [&](std::string_view name, std::size_t count, auto entries) {
    group(out, 0, "TABLE");
    group(out, 2, name);
    group(out, 70, std::to_string(count));
    entries();
    group(out, 0, "ENDTAB");
  };
  group(out, 0, "SECTION");
  group(out, 2, "HEADER");
  group(out, 9, "$ACADVER");
  group(out, 1, "AC1009");
  group(out, 0, "ENDSEC");
  group(out, 0, "SECTION");
  group(out, 2, "TABLES");
  table("LAYER", class_count, [&] {
    for (std::size_t c = 0; c < class_count; ++c) {
      group(out, 0, "LAYER");
      group(out, 2, class_name(static_cast<model::FaceClass>(c)));
      group(out, 70, "0");
      group(out, 62, std::to_string(colours[c]));
      group(out, 6, "CONTINUOUS");
    }
  });
  table("APPID", 1, [&] {
    group(out, 0, "APPID");
    group(out, 2, application);
    group(out, 70, "0");
  });
  group(out, 0, "ENDSEC");
  group(out, 0, "SECTION");
  group(out, 2, "ENTITIES");
  return out;
}

class DxfWriter : public CityWriter {
 public:
  DxfWriter(const Header& header, Solids solids, const LevelOf& level, base::Sink& file)
      : frame_(header.frame), solids_(solids), level_(level), file_(file) {
    file_.append(head());
  }

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    Drawn all = drawn(building, *keyed, solids_);
    level_.apply(all, frame_);
    warnings_.insert(warnings_.end(), all.warnings.begin(), all.warnings.end());
    std::string out;
    for (const auto& [part, parts] : all.solids) {
      const auto cut = triangles_of(part.model.solid, part.id);
      if (!cut) return cut.error();
      for (std::size_t t = 0; t < cut->triangles.size(); ++t)
        append(out, part.model, cut->triangles[t], cut->face_of[t], part.id);
    }
    file_.append(out);
    return {};
  }

  auto finish() -> base::Result<void> override {
    std::string out;
    group(out, 0, "ENDSEC");
    group(out, 0, "EOF");
    file_.append(out);
    return {};
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return warnings_; }

 private:
  void append(std::string& out, const model::LabelledSolid& model, const std::array<std::uint32_t, 3>& corners,
              std::uint32_t face, const std::string& id) const {
    group(out, 0, "3DFACE");
    group(out, 8, class_name(model.classes[face]));
    constexpr int corner_count = 4;  // the last one of a triangle comes twice
    for (int i = 0; i < corner_count; ++i) {
      const auto p = in_file_frame(frame_, model.solid.vertices[corners[static_cast<std::size_t>(std::min(i, 2))]]);
      group(out, 10 + i, base::to_text(p.x));
      group(out, 20 + i, base::to_text(p.y));
      group(out, 30 + i, base::to_text(p.z));
    }
    group(out, 1001, application);
    group(out, 1000, dxf_text(id));
  }

  const model::Frame frame_;
  const Solids solids_;
  const LevelOf level_;
  base::Sink& file_;
  Gate gate_;
  std::vector<base::Diagnostic> warnings_;
};

}  // namespace

auto dxf_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  const auto level = LevelOf::of(options, Format::dxf);
  if (!level) return level.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<DxfWriter>(header, options.solids, *level, **file));
}

}  // namespace mansard::formats::detail
