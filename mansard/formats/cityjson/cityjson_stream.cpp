#include "mansard/formats/cityjson/cityjson.hpp"

namespace mansard::formats::detail {
namespace {

/// One document. Its metadata come first and tell the extent of all, its vertices last: objects and vertices are put
/// aside until the end.
class WholeFile : public CityWriter {
 public:
  WholeFile(Header header, base::Sink& file, std::unique_ptr<base::Spool> objects,
            std::unique_ptr<base::Spool> vertices)
      : header_(std::move(header)),
        file_(file),
        objects_(std::move(objects)),
        vertices_(std::move(vertices)),
        text_(header_, *vertices_, 0) {}

  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    const auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    text_.add(building, *keys);
    objects_->append(text_.take());
    return {};
  }

  [[nodiscard]] auto finish() -> base::Result<void> override {
    objects_->append(text_.end());
    JsonText json = cityjson_head(header_, text_.extent(), 0);
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
};

class Sequence : public CityWriter {
 public:
  Sequence(Header header, base::Sink& file) : header_(std::move(header)), file_(file) {
    JsonText json = cityjson_head(header_, std::nullopt, -1);
    json.begin_object().end_object().key("vertices").begin_array().end_array().end_object();
    file_.append(json.take() + "\n");
  }

  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    const auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    file_.append(cityjson_feature(building, *keys, header_));
    return {};
  }
  [[nodiscard]] auto finish() -> base::Result<void> override { return {}; }

 private:
  const Header header_;
  base::Sink& file_;
  Gate gate_;
};

}  // namespace

auto cityjson_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult {
  const auto file = outputs.file(path);
  if (!file) return file.error();
  auto objects = base::Spool::open(), vertices = base::Spool::open();
  if (!objects) return objects.error();
  if (!vertices) return vertices.error();
  return WriterResult(std::make_unique<WholeFile>(header, **file, *std::move(objects), *std::move(vertices)));
}

auto cityjsonseq_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult {
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<Sequence>(header, **file));
}

}  // namespace mansard::formats::detail
