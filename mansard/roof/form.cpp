// From attributes to a form. What cannot be used is left out, and said.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/base/text.hpp"
#include "mansard/roof/detail/tags.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof {
namespace {

using detail::Key;
namespace keys = detail::keys;

constexpr double highest = 1500;  // m; the tallest building has 828

/// Metres or levels as a person would read them: nothing after the digits that count.
auto shown(double metres) -> std::string {
  std::string text = base::to_text(metres, 3);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

class Reader {
 public:
  Reader(const model::Attributes& attributes, const Options& options) : tags_(attributes, options), options_(options) {}

  auto read() -> Read {
    Form& form = out_.form;
    form.pitch = options_.pitch;
    form.most_share = options_.most_share;
    form.ground = value(keys::ground(), detail::length_of, "a height", -highest * 10, highest * 10, false)
                      .value_or(options_.ground);
    form.shape = shape();
    heights();
    form.base = base_height();
    if (form.shape != Shape::flat) {
      rise();
      form.orientation = orientation();
      form.direction = value(keys::direction(), detail::bearing_of, "a direction such as 135 or SE", 0, 7, false);
    }
    return std::move(out_);
  }

 private:
  void warn(std::string code, const detail::Tag& tag, const std::string& what) {
    out_.warnings.push_back(
        base::warning(std::move(code), tag.name + " = \"" + base::on_one_line(tag.text) + "\" " + what));
  }

  /// The tag's value within least … most; of several ("3;4") the greatest.
  template <class Parse>
  auto value(const Key& key, Parse parse, const std::string& kind, double least, double most, bool several)
      -> std::optional<double> {
    const auto tag = tags_.find(key);
    if (!tag) return std::nullopt;
    std::optional<double> best;
    std::size_t parts = 0;
    for (std::size_t at = 0; at <= tag->text.size(); ++parts) {
      const std::size_t end = several ? std::min(tag->text.find(';', at), tag->text.size()) : tag->text.size();
      const auto one = parse(std::string_view(tag->text).substr(at, end - at));
      if (!one) {
        warn("roof-value", *tag, "is not " + kind + "; it is left out");
        return std::nullopt;
      }
      best = std::max(best.value_or(*one), *one);
      at = end + 1;
    }
    if (!best || *best < least || *best > most) {
      warn("roof-value", *tag,
           (best && *best < least ? "is too little for " : "is too much for ") + kind + "; it is left out");
      return std::nullopt;
    }
    if (parts > 1) warn("roof-value", *tag, "has several values; the greatest was taken");
    return best;
  }

  auto shape() -> Shape {
    const auto tag = tags_.find(keys::shape());
    if (!tag) return options_.shape;
    const auto named = detail::shape_of(tag->text);
    if (!named) {
      warn("roof-shape-unknown", *tag, "is no shape known here; made " + std::string(to_string(options_.shape)));
      return options_.shape;
    }
    if (!named->exact) warn("roof-shape-unknown", *tag, "is made as " + std::string(to_string(named->shape)));
    return named->shape;
  }

  /// Height and eaves: `height` goes before levels, levels before the default.
  void heights() {
    constexpr double most_levels = highest / 3;
    Form& form = out_.form;
    constexpr double least_height = 0.1;
    const auto height = value(keys::height(), detail::length_of, "a height", least_height, highest, true);
    // Zero levels are a roof that stands on the ground; with a flat one, nothing would be left.
    const double least_levels = form.shape == Shape::flat ? 0.1 : 0;
    const auto levels =
        height ? std::nullopt
               : value(keys::levels(), detail::count_of, "a number of levels", least_levels, most_levels, true);
    if (height) {
      form.height = *height;
      form.source = Source::height;
    } else if (levels) {
      form.height = *levels * options_.level_height;
      form.roof_included = false;
      form.source = Source::levels;
    } else {
      form.height = options_.default_height;
    }
  }

  /// Of the levels below the roof: where height and number are given, what these say.
  auto level_height() -> double {
    const Form& form = out_.form;
    if (form.source != Source::height) return options_.level_height;
    const auto levels = value(keys::levels(), detail::count_of, "a number of levels", 0, highest, true);
    const auto tag = tags_.find(keys::roof_height());
    const double roof = tag && form.shape != Shape::flat ? detail::length_of(tag->text).value_or(0) : 0;
    if (!levels || *levels <= 0 || roof < 0 || roof >= form.height) return options_.level_height;
    return (form.height - roof) / *levels;
  }

  auto base_height() -> double {
    const Form& form = out_.form;
    auto found = value(keys::min_height(), detail::length_of, "a height", 0, highest, true);
    const Key& key = found ? keys::min_height() : keys::min_level();
    if (!found)
      if (const auto level = value(keys::min_level(), detail::count_of, "a number of levels", 0, highest, true))
        found = *level * level_height();
    if (!found) return 0;
    const bool room = form.roof_included || form.shape == Shape::flat ? *found < form.height : *found <= form.height;
    if (room) return *found;
    if (const auto tag = tags_.find(key))
      warn("roof-conflict", *tag, "is not below the building's " + shown(form.height) + " m; it is left out");
    return 0;
  }

  void rise() {
    Form& form = out_.form;
    auto found = value(keys::roof_height(), detail::length_of, "a height", 0, highest, true);
    const Key& key = found ? keys::roof_height() : keys::roof_levels();
    if (!found)
      if (const auto levels = value(keys::roof_levels(), detail::count_of, "a number of levels", 0, highest, true);
          levels && *levels > 0)  // none means no storey under the roof, not that there is no roof
        found = *levels * options_.level_height;
    const double room = form.height - form.base;
    if (found && form.roof_included && *found > room + 1e-6) {
      if (const auto tag = tags_.find(key))
        warn("roof-conflict", *tag,
             "is " + shown(*found) + " m, more than the building's " + shown(room) + " m; it is left out");
      found.reset();
    }
    form.rise = found;
    constexpr double steepest = 85 * std::numbers::pi / 180, flattest = 0.001;
    if (!found) form.angle = value(keys::angle(), detail::angle_of, "a pitch in degrees", flattest, steepest, false);
    // A roof on no wall at all needs a height.
    if (!form.roof_included && room <= 0 && form.rise.value_or(1) <= 0) form.rise.reset();
  }

  auto orientation() -> std::optional<Orientation> {
    const auto tag = tags_.find(keys::orientation());
    if (!tag) return std::nullopt;
    const auto word = base::lower(tag->text);
    if (word == "along") return Orientation::along;
    if (word == "across") return Orientation::across;
    warn("roof-value", *tag, "is neither along nor across; it is left out");
    return std::nullopt;
  }

  detail::Tags tags_;
  const Options& options_;
  Read out_;
};

}  // namespace

auto form_of(const model::Attributes& attributes, const Options& options) -> Read {
  return Reader(attributes, options).read();
}

}  // namespace mansard::roof
