#include "mansard/formats/cityjson/cityjson.hpp"

namespace mansard::formats::detail {
namespace {

/// What both kinds of file have.
class Textured : public CityWriter, protected TextureQueue {
 public:
  Textured(Header header, CityJsonOptions own, const WriteOptions& options, TextureFolder folder)
      : TextureQueue(options), header_(std::move(header)), own_(std::move(own)), folder_(std::move(folder)) {}

  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> final {
    auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    return put(building, *std::move(keys));
  }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> final { return warnings_; }

 protected:
  [[nodiscard]] auto images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> final {
    return folder_.write(atlas);
  }
  [[nodiscard]] auto header() const -> const Header& { return header_; }
  [[nodiscard]] auto own() const -> const CityJsonOptions& { return own_; }
  [[nodiscard]] auto folder() const -> const TextureFolder& { return folder_; }
  [[nodiscard]] auto told() -> std::vector<base::Diagnostic>& { return warnings_; }

 private:
  const Header header_;
  const CityJsonOptions own_;
  std::vector<base::Diagnostic> warnings_;
  TextureFolder folder_;
  Gate gate_;
};

/// One document. Its metadata come first and tell the extent of all, its vertices last: objects and vertices are put
/// aside until the end.
class WholeFile : public Textured {
 public:
  struct Spools {
    std::unique_ptr<base::Spool> objects, vertices, coordinates;
  };
  WholeFile(const Header& header, CityJsonOptions own, const WriteOptions& options, base::Sink& file,
            TextureFolder folder, Spools spools)
      : Textured(header, std::move(own), options, std::move(folder)),
        file_(file),
        spools_(std::move(spools)),
        uv_(*spools_.coordinates, false),
        text_(header, this->own(), *spools_.vertices, 0, &uv_) {}

  [[nodiscard]] auto finish() -> base::Result<void> override {
    if (auto done = empty(); !done) return done;
    spools_.objects->append(text_.end());
    JsonText json = cityjson_head(header(), own(), text_.extent(), 0);
    file_.append(json.take());
    if (auto copied = spools_.objects->copy_to(file_); !copied) return copied;
    json.aside();
    if (uv_.count() > 0) {
      file_.append(json.line().key("appearance").take() + appearance_head(uv_, folder()).take());
      if (auto copied = spools_.coordinates->copy_to(file_); !copied) return copied;
      file_.append("]}");
      json.aside();
    }
    file_.append(json.line().key("vertices").begin_array().take());
    if (auto copied = spools_.vertices->copy_to(file_); !copied) return copied;
    file_.append(json.aside().end_array().line().end_object().take() + "\n");
    return {};
  }

 private:
  auto write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
      -> base::Result<void> override {
    text_.add(building, keys, told(), textured);
    spools_.objects->append(text_.take());
    return {};
  }

  base::Sink& file_;
  Spools spools_;
  TextureVertices uv_;
  CityObjects text_;
};

class Sequence : public Textured {
 public:
  Sequence(const Header& header, CityJsonOptions own, const WriteOptions& options, base::Sink& file,
           TextureFolder folder)
      : Textured(header, std::move(own), options, std::move(folder)), file_(file) {
    JsonText json = cityjson_head(header, this->own(), std::nullopt, -1);
    json.begin_object().end_object().key("vertices").begin_array().end_array().end_object();
    file_.append(json.take() + "\n");
  }
  [[nodiscard]] auto finish() -> base::Result<void> override { return empty(); }

 private:
  auto write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
      -> base::Result<void> override {
    file_.append(cityjson_feature(building, keys, header(), own(), told(), textured, &folder()));
    return {};
  }

  base::Sink& file_;
};

}  // namespace

auto cityjson_options(const WriteOptions& options, Format format) -> base::Result<CityJsonOptions> {
  auto lods = lods_of(options.lod, format);
  if (!lods) return lods.failure();
  CityJsonOptions out{options.solids, std::move(*lods), options.levels,  options.title,
                      options.date,   options.lineage,  options.contact, {}};
  const auto wrong = [](const std::string& what, const char* name) {
    return base::error("option-value", what, std::string("write.") + name);
  };
  const auto is_date = [](std::string_view text) {
    bool ok = text.size() == 10 && text[4] == '-' && text[7] == '-';
    for (std::size_t i = 0; ok && i < text.size(); ++i) ok = i == 4 || i == 7 || (text[i] >= '0' && text[i] <= '9');
    return ok;
  };
  if (!out.date.empty() && !is_date(out.date))
    return wrong("'" + out.date + "' is not a date; expected YYYY-MM-DD", "date");
  if (!out.contact.empty()) {
    const auto start = out.contact.find('<'), end = out.contact.find('>');
    const bool found = start != std::string::npos && end != std::string::npos && end > start + 1;
    if (!found || out.contact.find('@', start) == std::string::npos || out.contact.find('@', start) > end)
      return wrong("'" + out.contact + "' has no e-mail address; expected a name and an address in < >", "contact");
    out.email = out.contact.substr(start + 1, end - start - 1);
    out.contact.resize(start);
    while (!out.contact.empty() && out.contact.back() == ' ') out.contact.pop_back();
    if (out.contact.empty()) return wrong("there is no name before the e-mail address", "contact");
  }
  return out;
}

auto cityjson_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  auto own = cityjson_options(options, Format::cityjson);
  if (!own) return own.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  WholeFile::Spools spools;
  for (auto* spool : {&spools.objects, &spools.vertices, &spools.coordinates}) {
    auto opened = base::Spool::open();
    if (!opened) return opened.error();
    *spool = *std::move(opened);
  }
  return WriterResult(std::make_unique<WholeFile>(header, *std::move(own), options, **file,
                                                  TextureFolder(path, options, outputs), std::move(spools)));
}

auto cityjsonseq_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  auto own = cityjson_options(options, Format::cityjsonseq);
  if (!own) return own.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(
      std::make_unique<Sequence>(header, *std::move(own), options, **file, TextureFolder(path, options, outputs)));
}

}  // namespace mansard::formats::detail
