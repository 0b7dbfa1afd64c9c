#include "mansard/base/options.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "mansard/base/bound_text.hpp"

namespace mansard::base {
namespace {

auto bad_value(const std::string& module, const Option& option, std::string_view given, const std::string& wanted)
    -> Diagnostic {
  return error("option-value", "'" + std::string(given) + "' is not " + wanted + "; see 'mansard options'",
               module + "." + option.name);
}

auto in_words(const Range& range, const std::string& unit) -> std::string {
  const bool low = range.minimum > -std::numeric_limits<double>::infinity();
  const bool high = range.maximum < std::numeric_limits<double>::infinity();
  const std::string tail = unit.empty() ? "" : " " + unit;
  if (low && high) return " from " + bound_text(range.minimum) + " to " + bound_text(range.maximum) + tail;
  if (low) return " of at least " + bound_text(range.minimum) + tail;
  if (high) return " of at most " + bound_text(range.maximum) + tail;
  return "";
}

auto contains(const Range& range, double value) -> bool { return value >= range.minimum && value <= range.maximum; }

auto described(Option::Kind kind, std::string name, std::string meaning, std::string unit, Range range) -> Option {
  Option option;
  option.kind = kind;
  option.name = std::move(name);
  option.meaning = std::move(meaning);
  option.unit = std::move(unit);
  option.range = range;
  return option;
}

template <class Integer>
auto integer_option(Option option, Integer& member, const std::string& module) -> Option {
  option.get = [&member] { return std::to_string(member); };
  option.set = [&member, module, described = option](std::string_view given) -> Result<void> {
    const auto value = to_integer(given);
    if (!value || !contains(described.range, static_cast<double>(*value)))
      return bad_value(module, described, given, "an integer" + in_words(described.range, described.unit));
    member = static_cast<Integer>(*value);
    return {};
  };
  return option;
}

}  // namespace

auto bound_text(double bound) -> std::string {
  std::string text = to_text(bound);
  for (const std::string_view sign : {"e+0", "e+"})
    if (const auto at = text.find(sign); at != std::string::npos) text.replace(at, sign.size(), "e");
  return text;
}

auto OptionList::add(Option option) -> OptionList& {
  assert(find(option.name) == nullptr);
  options_.push_back(std::move(option));
  return *this;
}

auto OptionList::alias(std::string name) -> OptionList& {
  assert(!options_.empty());
  options_.back().alias = std::move(name);
  return *this;
}

auto OptionList::source(std::string source) -> OptionList& {
  assert(!options_.empty());
  options_.back().source = std::move(source);
  return *this;
}

auto OptionList::advanced(std::string source) -> OptionList& {
  this->source(std::move(source));
  options_.back().advanced = true;
  return *this;
}

auto OptionList::find(std::string_view name) const -> const Option* {
  const auto at = std::ranges::find(options_, name, &Option::name);
  return at == options_.end() ? nullptr : &*at;
}

auto OptionList::flag(std::string name, bool& member, std::string meaning) -> OptionList& {
  Option option;
  option.name = std::move(name);
  option.meaning = std::move(meaning);
  option.kind = Option::Kind::flag;
  option.choices = {"true", "false"};
  option.get = [&member] { return std::string(member ? "true" : "false"); };
  option.set = [&member, module = module_, option](std::string_view given) -> Result<void> {
    if (given != "true" && given != "false") return bad_value(module, option, given, "true or false");
    member = given == "true";
    return {};
  };
  return add(std::move(option));
}

auto OptionList::integer(std::string name, std::int64_t& member, std::string unit, Range range, std::string meaning)
    -> OptionList& {
  return add(integer_option(
      described(Option::Kind::integer, std::move(name), std::move(meaning), std::move(unit), range), member, module_));
}

auto OptionList::integer(std::string name, std::size_t& member, std::string unit, Range range, std::string meaning)
    -> OptionList& {
  assert(range.minimum >= 0);
  return add(integer_option(
      described(Option::Kind::integer, std::move(name), std::move(meaning), std::move(unit), range), member, module_));
}

auto OptionList::number(std::string name, double& member, std::string unit, Range range, std::string meaning)
    -> OptionList& {
  Option option = described(Option::Kind::number, std::move(name), std::move(meaning), std::move(unit), range);
  option.get = [&member] { return to_text(member); };
  option.set = [&member, module = module_, option](std::string_view given) -> Result<void> {
    const auto value = to_number(given);
    if (!value || !contains(option.range, *value))
      return bad_value(module, option, given, "a number" + in_words(option.range, option.unit));
    member = *value;
    return {};
  };
  return add(std::move(option));
}

auto OptionList::number(std::string name, std::optional<double>& member, std::string unit, Range range,
                        std::string meaning) -> OptionList& {
  Option option = described(Option::Kind::number, std::move(name), std::move(meaning), std::move(unit), range);
  option.get = [&member] { return member ? to_text(*member) : std::string(); };
  option.set = [&member, module = module_, option](std::string_view given) -> Result<void> {
    if (given.empty()) return member.reset(), Result<void>{};
    const auto value = to_number(given);
    if (!value || !contains(option.range, *value))
      return bad_value(module, option, given, "a number" + in_words(option.range, option.unit));
    member = *value;
    return {};
  };
  return add(std::move(option));
}

auto OptionList::numbers(std::string name, std::span<double> members, std::string unit, Range range,
                         std::string meaning) -> OptionList& {
  Option option = described(Option::Kind::string, std::move(name), std::move(meaning), std::move(unit), range);
  option.get = [members] {
    std::string all;
    for (const double member : members) all += (all.empty() ? "" : " ") + to_text(member);
    return all;
  };
  option.set = [members, module = module_, option](std::string_view given) -> Result<void> {
    std::vector<std::optional<double>> values;
    constexpr std::string_view between = " ,";
    for (std::size_t at = 0; (at = given.find_first_not_of(between, at)) != given.npos;) {
      const std::size_t end = std::min(given.find_first_of(between, at), given.size());
      values.push_back(to_number(given.substr(at, end - at)));
      at = end;
    }
    const auto usable = [&option](const auto& value) { return value && contains(option.range, *value); };
    if (values.size() != members.size() || !std::ranges::all_of(values, usable))
      return bad_value(module, option, given,
                       std::to_string(members.size()) + " numbers" + in_words(option.range, option.unit));
    std::ranges::transform(values, members.begin(), [](const auto& value) { return *value; });
    return {};
  };
  return add(std::move(option));
}

auto OptionList::string(std::string name, std::string& member, std::string meaning) -> OptionList& {
  Option option;
  option.name = std::move(name);
  option.meaning = std::move(meaning);
  option.kind = Option::Kind::string;
  option.get = [&member] { return member; };
  option.set = [&member](std::string_view given) -> Result<void> {
    member = std::string(given);
    return {};
  };
  return add(std::move(option));
}

auto OptionList::add_choice(std::string name, std::vector<std::string> words, std::string meaning,
                            std::function<std::string()> get, std::function<bool(std::string_view)> put)
    -> OptionList& {
  Option option;
  option.name = std::move(name);
  option.meaning = std::move(meaning);
  option.kind = Option::Kind::choice;
  option.choices = std::move(words);
  option.get = std::move(get);
  option.set = [put = std::move(put), module = module_, option](std::string_view given) -> Result<void> {
    if (put(given)) return {};
    std::string wanted = "one of";
    for (const auto& word : option.choices) wanted += (word == option.choices.front() ? " " : ", ") + word;
    return bad_value(module, option, given, wanted);
  };
  return add(std::move(option));
}

auto nearest_word(std::string_view word, const std::vector<std::string>& known) -> std::optional<std::string> {
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
        diagonal = above;
      }
    }
    return row.back();
  };
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& candidate : known) {
    const std::size_t d = distance(word, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

auto did_you_mean(const std::optional<std::string>& word) -> std::string {
  return word ? "; did you mean '" + *word + "'?" : std::string();
}

}  // namespace mansard::base
