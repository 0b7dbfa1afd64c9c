#include "mansard/write/detail/writers.hpp"

namespace mansard::write::detail {
namespace {

class WholeReader : public CityReader {
 public:
  WholeReader(City city, bool with_models)
      : header_{std::move(city.frame), std::move(city.made_by)},
        left_(std::move(city.buildings)),
        with_models_(with_models) {}
  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return with_models_; }
  [[nodiscard]] auto next() -> base::Result<std::optional<Building>> override {
    if (at_ == left_.size()) return std::optional<Building>();
    return std::optional<Building>(std::move(left_[at_++]));
  }

 private:
  Header header_;
  std::vector<Building> left_;
  bool with_models_;
  std::size_t at_ = 0;
};

}  // namespace

auto whole_reader(City city, bool with_models) -> std::unique_ptr<CityReader> {
  return std::make_unique<WholeReader>(std::move(city), with_models);
}

}  // namespace mansard::write::detail
