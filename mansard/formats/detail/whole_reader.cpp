#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {
namespace {

class WholeReader : public CityReader {
 public:
  WholeReader(model::City city, Models models, std::vector<base::Diagnostic> refused)
      : header_{std::move(city.frame), std::move(city.made_by)},
        left_(std::move(city.buildings)),
        models_(models),
        refused_(std::move(refused)) {}
  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return models_ == Models::of_parts; }
  [[nodiscard]] auto has_solids() const -> bool override { return models_ == Models::of_buildings; }
  [[nodiscard]] auto next() -> base::Result<std::optional<model::Building>> override {
    if (at_ == left_.size()) return std::optional<model::Building>();
    return std::optional<model::Building>(std::move(left_[at_++]));
  }
  [[nodiscard]] auto refused() const -> std::vector<base::Diagnostic> override { return refused_; }

 private:
  Header header_;
  std::vector<model::Building> left_;
  Models models_;
  std::vector<base::Diagnostic> refused_;
  std::size_t at_ = 0;
};

}  // namespace

auto whole_reader(model::City city, Models models, std::vector<base::Diagnostic> refused)
    -> std::unique_ptr<CityReader> {
  return std::make_unique<WholeReader>(std::move(city), models, std::move(refused));
}

}  // namespace mansard::formats::detail
