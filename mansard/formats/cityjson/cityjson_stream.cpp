#include "mansard/formats/cityjson/cityjson.hpp"

namespace mansard::formats::detail {
namespace {

/// One document. Its metadata come first and tell the extent of all, its vertices last: objects and vertices are put
/// aside until the end.
class WholeFile : public CityWriter {
 public:
  WholeFile(Header header, Solids solids, base::Sink& file, std::unique_ptr<base::Spool> objects,
            std::unique_ptr<base::Spool> vertices)
      : header_(std::move(header)),
        file_(file),
        objects_(std::move(objects)),
        vertices_(std::move(vertices)),
        text_(header_, solids, *vertices_, 0) {}

  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    const auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    text_.add(building, *keys, warnings_);
    objects_->append(text_.take());
    return {};
  }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return warnings_; }

  [[nodiscard]] auto finish() -> base::Result<void> override {
    objects_->append(text_.end());
    JsonText json = cityjson_head(header_, text_.solids(), text_.extent(), 0);
    file_.append(json.take());
    if (auto copied = objects_->copy_to(file_); !copied) return copied;
    file_.append(json.aside().line().key("vertices").begin_array().take());
    if (auto copied = vertices_->copy_to(file_); !copied) return copied;
    file_.append(json.aside().end_array().line().end_object().take() + "\n");
    return {};
  }

 private:
  const Header header_;
  base::Sink& file_;
  std::unique_ptr<base::Spool> objects_, vertices_;
  Gate gate_;
  CityObjects text_;
  std::vector<base::Diagnostic> warnings_;
};

class Sequence : public CityWriter {
 public:
  Sequence(Header header, Solids solids, base::Sink& file) : header_(std::move(header)), solids_(solids), file_(file) {
    JsonText json = cityjson_head(header_, solids_, std::nullopt, -1);
    json.begin_object().end_object().key("vertices").begin_array().end_array().end_object();
    file_.append(json.take() + "\n");
  }

  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    const auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    file_.append(cityjson_feature(building, *keys, header_, solids_, warnings_));
    return {};
  }
  [[nodiscard]] auto finish() -> base::Result<void> override { return {}; }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return warnings_; }

 private:
  const Header header_;
  const Solids solids_;
  base::Sink& file_;
  Gate gate_;
  std::vector<base::Diagnostic> warnings_;
};

}  // namespace

auto cityjson_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  const auto file = outputs.file(path);
  if (!file) return file.error();
  auto objects = base::Spool::open(), vertices = base::Spool::open();
  if (!objects) return objects.error();
  if (!vertices) return vertices.error();
  return WriterResult(
      std::make_unique<WholeFile>(header, options.solids, **file, *std::move(objects), *std::move(vertices)));
}

auto cityjsonseq_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<Sequence>(header, options.solids, **file));
}

}  // namespace mansard::formats::detail
