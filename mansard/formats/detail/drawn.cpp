#include "mansard/formats/detail/drawn.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mansard/solid/unite.hpp"

namespace mansard::formats::detail {
namespace {

enum class Rule : std::uint8_t { least, greatest, sum, mean, mean_square, first_text, same };

auto rule_of(std::string_view name) -> Rule {
  if (name.ends_with("_min") || name == "ms_h_ground") return Rule::least;
  if (name.ends_with("_max") || name == "ms_h_ridge") return Rule::greatest;
  if (name == "ms_fallback") return Rule::first_text;
  constexpr std::string_view ours = "ms_";
  if (!name.starts_with(ours)) return Rule::same;
  const auto kind = name.substr(ours.size());
  if (kind.starts_with("volume") || kind.starts_with("area")) return Rule::sum;
  if (kind.starts_with("rmse")) return Rule::mean_square;
  if (kind.starts_with("h_")) return Rule::mean;
  return Rule::same;
}

struct Known {
  double value, weight;
};

auto reduced(Rule rule, const std::vector<Known>& known) -> double {
  double least = known.front().value, most = least, sum = 0, weighted = 0, squared = 0, weight = 0;
  for (const auto& [v, w] : known) {
    least = std::min(least, v), most = std::max(most, v), sum += v;
    weighted += w * v, squared += w * v * v, weight += w;
  }
  switch (rule) {
    case Rule::least: return least;
    case Rule::greatest: return most;
    case Rule::sum: return sum;
    case Rule::mean_square: return weight > 0 ? std::sqrt(squared / weight) : most;
    default: return weight > 0 ? weighted / weight : most;
  }
}

auto value_in(const model::Attributes& attributes, std::string_view name) -> const model::Value* {
  const model::Value* found = nullptr;
  for (const auto& [key, value] : attributes)
    if (key == name) found = &value;
  return found;
}

auto merged(std::string_view name, const std::vector<const model::Part*>& parts) -> model::Value {
  const Rule rule = rule_of(name);
  std::vector<Known> known;
  const model::Value* first = nullptr;
  bool same = true;
  for (const model::Part* part : parts) {
    const model::Value* value = value_in(part->attributes, name);
    if (value == nullptr || std::holds_alternative<std::monostate>(*value)) {
      same = same && rule == Rule::first_text;
      continue;
    }
    if (const double* number = std::get_if<double>(value))
      known.push_back({*number, geometry::area(geometry::oriented(model::polygon_of(part->plan)))});
    if (first == nullptr) first = value;
    else same = same && (*first == *value || rule == Rule::first_text);
  }
  if (!known.empty() && rule != Rule::same && rule != Rule::first_text) return reduced(rule, known);
  return first != nullptr && same ? *first : model::Value();
}

}  // namespace

auto merged_attributes(const std::vector<const model::Part*>& parts) -> model::Attributes {
  if (parts.size() == 1) return parts.front()->attributes;
  model::Attributes out;
  std::set<std::string_view> seen;
  for (const model::Part* part : parts)
    for (const auto& [name, value] : part->attributes)
      if (seen.insert(name).second) out.emplace_back(name, merged(name, parts));
  return out;
}

auto drawn(const model::Building& building, const Gate::Keyed& keys, Solids solids) -> Drawn {
  Drawn out;
  const auto take = [&](solid::United united, const std::vector<std::size_t>& numbers) {
    const bool one = solids == Solids::building && united.solids.size() == 1;
    std::set<std::string> taken;
    for (auto& solid : united.solids) {
      std::vector<const model::Part*> parts;
      for (std::size_t& p : solid.of) {
        p = numbers[p];
        parts.push_back(&building.parts[p]);
      }
      std::string key = one ? keys.building : keys.parts[solid.of.front()];
      while (!taken.insert(key).second) key += "-piece";
      out.solids.push_back(
          {{std::move(key), {}, std::move(solid.model), merged_attributes(parts)}, std::move(solid.of)});
    }
    for (auto& warning : united.warnings) {
      warning.subject = building.id;
      out.warnings.push_back(std::move(warning));
    }
  };
  std::vector<std::size_t> numbers;
  const bool each_of_a_part =
      std::ranges::all_of(building.solids, [](const auto& solid) { return solid.parts.size() == 1; });
  if (!building.solids.empty() && (solids == Solids::building || each_of_a_part)) {
    for (std::size_t p = 0; p < building.parts.size(); ++p) numbers.push_back(p);
    for (std::size_t i = 0; i < building.solids.size();) {
      solid::United made;  // of the building, or of a part with its pieces
      const auto& of = building.solids[i].parts;
      do made.solids.push_back({building.solids[i].parts, building.solids[i].model, {}});
      while (++i < building.solids.size() && (solids == Solids::building || building.solids[i].parts == of));
      take(std::move(made), numbers);
    }
    return out;
  }
  std::vector<const model::LabelledSolid*> models;
  for (std::size_t p = 0; p < building.parts.size(); ++p) {
    const auto& model = building.parts[p].model;
    if (model.solid.faces.empty()) continue;
    models.push_back(&model);
    numbers.push_back(p);
  }
  if (solids == Solids::building) {
    take(solid::unite(models), numbers);
    return out;
  }
  // Over one plan, so that parts share walls exactly.
  auto made = solid::share_walls(models) ? std::vector<solid::United>(models.size()) : solid::unite_each(models);
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (made[i].solids.empty()) made[i].solids.push_back({{0}, *models[i], {}});  // its writer says what is wrong
    take(std::move(made[i]), {numbers[i]});
  }
  return out;
}

}  // namespace mansard::formats::detail
