#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats::detail {
namespace {

class Plans : public CityWriter {
 public:
  Plans(const Header& header, base::Sink& sink) : text_(header, sink) {}
  [[nodiscard]] auto add(const model::Building& building) -> base::Result<void> override {
    if (const auto keyed = gate_.admit(building); !keyed) return keyed.error();
    text_.add(building);
    return {};
  }
  [[nodiscard]] auto finish() -> base::Result<void> override {
    text_.end();
    return {};
  }

 private:
  Gate gate_;
  PlansText text_;
};

}  // namespace

auto plans_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult {
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<Plans>(header, **file));
}

}  // namespace mansard::formats::detail
