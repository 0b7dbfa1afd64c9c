// One option list per module feeds the command line, the config file, its validation and the docs.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/text.hpp"

namespace mansard::base {

/// A closed interval an option must lie in.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

/// One option, bound to a member of a module's options struct: its default is the member's initialiser.
struct Option {
  enum class Kind { flag, integer, number, string, choice };

  std::string name;     ///< snake_case, unique in its module; `--module-name` with dashes on the command line
  std::string meaning;  ///< one sentence
  std::string unit;     ///< "m", "m²", "rad", "s"; empty for none
  Kind kind = Kind::string;
  Range range;
  std::vector<std::string> choices;
  std::string alias;      ///< a short command line name without dashes ("gamma"); empty for none
  std::string source;     ///< where the default comes from: a paper's section, a measurement, a derivation
  bool advanced = false;  ///< shown by `mansard options --all` only; few users have a reason to change it

  std::function<std::string()> get;                   ///< the present value as text; "" when absent
  std::function<Result<void>(std::string_view)> set;  ///< error code "option-value" when it cannot be taken
};

/// The options of one module, bound to one instance of its struct (which must outlive the list).
class OptionList {
 public:
  explicit OptionList(std::string module) : module_(std::move(module)) {}

  auto flag(std::string name, bool& member, std::string meaning) -> OptionList&;
  auto integer(std::string name, std::int64_t& member, std::string unit, Range range, std::string meaning)
      -> OptionList&;
  /// A count: the range begins at 0 or above.
  auto integer(std::string name, std::size_t& member, std::string unit, Range range, std::string meaning)
      -> OptionList&;
  auto number(std::string name, double& member, std::string unit, Range range, std::string meaning) -> OptionList&;
  auto number(std::string name, std::optional<double>& member, std::string unit, Range range, std::string meaning)
      -> OptionList&;
  /// Several numbers as one text, separated by blanks ("84800 447400 0"): exactly as many as there are members.
  auto numbers(std::string name, std::span<double> members, std::string unit, Range range, std::string meaning)
      -> OptionList&;
  auto string(std::string name, std::string& member, std::string meaning) -> OptionList&;

  /// An enumeration by its names.
  template <class E>
  auto choice(const std::string& name, E& member, std::vector<std::pair<std::string, E>> names,
              const std::string& meaning) -> OptionList& {
    std::vector<std::string> words;
    for (const auto& entry : names) words.push_back(entry.first);
    auto get = [&member, names]() -> std::string {
      for (const auto& entry : names)
        if (entry.second == member) return entry.first;
      return {};
    };
    auto put = [&member, names = std::move(names)](std::string_view word) -> bool {
      for (const auto& entry : names)
        if (entry.first == word) return member = entry.second, true;
      return false;
    };
    return add_choice(name, std::move(words), meaning, std::move(get), std::move(put));
  }

  /// Gives the option added last a second, short name on the command line.
  auto alias(std::string name) -> OptionList&;
  /// Says of the option added last where its default comes from.
  auto source(std::string source) -> OptionList&;
  /// The same, and puts it among the advanced options.
  auto advanced(std::string source) -> OptionList&;

  [[nodiscard]] auto module() const -> const std::string& { return module_; }
  [[nodiscard]] auto options() const -> const std::vector<Option>& { return options_; }
  [[nodiscard]] auto find(std::string_view name) const -> const Option*;

 private:
  auto add(Option option) -> OptionList&;
  auto add_choice(std::string name, std::vector<std::string> words, std::string meaning,
                  std::function<std::string()> get, std::function<bool(std::string_view)> put) -> OptionList&;

  std::string module_;
  std::vector<Option> options_;
};

/// The known word nearest to a misspelt one (edit distance at most a third of its length), if any.
[[nodiscard]] auto nearest_word(std::string_view word, const std::vector<std::string>& known)
    -> std::optional<std::string>;

/// "; did you mean 'word'?" for the end of a message; nothing for nothing.
[[nodiscard]] auto did_you_mean(const std::optional<std::string>& word) -> std::string;

}  // namespace mansard::base
