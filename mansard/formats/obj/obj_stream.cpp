#include <fstream>

#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/obj/obj_text.hpp"

namespace mansard::formats::detail {
namespace {

class Obj : public CityWriter, private TextureQueue {
 public:
  /// No file of plans for models that have none.
  Obj(ObjText text, const WriteOptions& options, base::Sink& file, base::Sink& library, base::Sink* plans,
      TextureFolder folder)
      : TextureQueue(options),
        text_(std::move(text)),
        file_(file),
        library_(library),
        plans_(plans),
        folder_(std::move(folder)) {}
  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    return put(building, *std::move(keys));
  }
  [[nodiscard]] auto finish() -> base::Result<void> override { return empty(); }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return text_.warnings(); }

 private:
  [[nodiscard]] auto write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
      -> base::Result<void> override {
    const auto text = text_.of(building, keys, textured);
    if (!text) return text.error();
    file_.append(*text);
    if (plans_ != nullptr) plans_->append(building_record(building) + "\n");
    return {};
  }

  [[nodiscard]] auto images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> override {
    auto first = folder_.write(atlas);
    if (first)
      for (std::uint32_t page = *first; page < folder_.pages(); ++page)
        library_.append(textured_mtl_text(page, folder_.name(page)));
    return first;
  }

  Gate gate_;
  ObjText text_;
  base::Sink &file_, &library_;
  base::Sink* plans_;
  TextureFolder folder_;
};

/// The records of the file beside an OBJ, or those among the comments of an older OBJ.
class ReadObj : public CityReader {
 public:
  static auto open(const Path& path) -> ReaderResult {
    std::error_code status;
    if (!std::filesystem::exists(path, status))
      return base::error("file-missing", "there is no such file; look at its name", path.string());
    const auto beside = obj_plans(path);
    const bool apart = std::filesystem::exists(beside, status);
    auto reader = std::unique_ptr<ReadObj>(new ReadObj(apart ? beside : path, apart));
    const auto record = reader->next_record(obj_header);
    if (!record)
      return base::error("write-read-plans",
                         "this OBJ has no plans, and there is no " + beside.filename().string() +
                             " beside it; give both files that mansard wrote, or another format",
                         path.string());
    auto header = read_header_record(*record, reader->place());
    if (!header) return header.error();
    reader->header_ = *std::move(header);
    return ReaderResult(std::move(reader));
  }

  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return false; }
  [[nodiscard]] auto next() -> base::Result<std::optional<model::Building>> override {
    const auto record = next_record(obj_building);
    if (!record && file_.bad())
      return base::error("file-read", "cannot read this file to its end; is it whole?", name_);
    if (!record) return std::optional<model::Building>();
    auto building = read_building_record(*record, place());
    if (!building) return building.error();
    return std::optional<model::Building>(*std::move(building));
  }

 private:
  ReadObj(const Path& path, bool apart) : name_(path.string()), apart_(apart), file_(path, std::ios::binary) {}
  [[nodiscard]] auto place() const -> std::string { return name_ + ":" + std::to_string(line_); }
  auto next_record(std::string_view kind) -> std::optional<std::string> {
    for (std::string line; std::getline(file_, line);) {
      ++line_;
      if (apart_ && line.find_first_not_of(" \t\r") != std::string::npos) return line;
      if (!apart_ && line.starts_with(kind)) return line.substr(kind.size());
    }
    return std::nullopt;
  }

  const std::string name_;
  const bool apart_;  ///< whether every line is a record
  std::ifstream file_;
  std::size_t line_ = 0;
  Header header_;
};

}  // namespace

auto obj_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  const auto level = LevelOf::of(options, Format::obj);
  if (!level) return level.error();
  auto library = path;
  library.replace_extension(".mtl");
  const auto file = outputs.file(path);
  if (!file) return file.error();
  const auto materials = outputs.file(library);
  if (!materials) return materials.error();
  base::Sink* plans = nullptr;
  if (!is_foreign(header)) {
    const auto made = outputs.file(obj_plans(path));
    if (!made) return made.error();
    plans = *made;
    plans->append(header_record(header) + "\n");
  }
  (*materials)->append(mtl_text());
  ObjText text(header, options, *level);
  (*file)->append(text.head(header, library.filename().string()));
  return WriterResult(std::make_unique<Obj>(std::move(text), options, **file, **materials, plans,
                                            TextureFolder(path, options, outputs)));
}

auto obj_reader(const Path& path) -> ReaderResult { return ReadObj::open(path); }

}  // namespace mansard::formats::detail
