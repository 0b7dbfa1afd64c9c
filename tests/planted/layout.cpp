#include "layout.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::planted {
namespace {

using geometry::Point2;

/// A street front: s runs along it, t away from the street.
struct Front {
  Point2 origin, along;
  [[nodiscard]] auto at(double s, double t) const -> Point2 {
    return origin + s * along + t * geometry::left_of(along);
  }
  [[nodiscard]] auto box(double s0, double s1, double t0, double t1) const -> geometry::Polygon {
    return {{at(s0, t0), at(s1, t0), at(s1, t1), at(s0, t1)}, {}};
  }
};

/// Draws houses one after the other; each is a neighbour of the one before, in height.
class Builder {
 public:
  explicit Builder(const Recipe& recipe) : recipe_(recipe), plan_(recipe.seed, 1), heights_(recipe.seed, 2) {}

  [[nodiscard]] auto width() -> double {
    return std::round(4 * plan_.uniform(recipe_.width_least, recipe_.width_most)) / 4;
  }

  /// Forgets the neighbour: the next house is as high as it likes.
  void start_row() { eaves_ = heights_.uniform(recipe_.eaves_least, 0.5 * (recipe_.eaves_least + recipe_.eaves_most)); }

  /// A house over [s0, s1] of the front, with what the recipe says of setbacks and wings.
  void house(const Front& front, double s0, double s1, bool may_step_back, bool may_have_wing) {
    draw_height();
    const double back = plan_.uniform() < recipe_.setback ? 0.25 * static_cast<double>(1 + plan_.index(5)) : 0;
    const bool wing = plan_.uniform() < recipe_.wings;
    const double reach = 3 + 0.25 * static_cast<double>(plan_.index(9));
    const double side = plan_.uniform();
    mass(front, front.box(s0, s1, may_step_back ? back : 0, recipe_.depth), roof_, eaves_, feature_);
    if (may_have_wing && wing) {
      const double half = std::floor(2 * (s1 - s0)) / 4;
      const double from = side < 0.5 ? s0 : s1 - half;
      mass(front, front.box(from, from + half, recipe_.depth, recipe_.depth + reach), Roof::flat,
           std::max(2.75, eaves_ - 3 - reach / 2), feature_);
    }
    if (recipe_.features == Features::per_house) ++feature_;
  }

  void mass(const Front& front, geometry::Polygon polygon, Roof roof, double eaves, std::size_t feature) {
    House h{std::move(polygon), feature, roof, eaves, 0, front.along, 0, 0};
    if (roof != Roof::gable_across) h.across = geometry::left_of(front.along);
    h.least = h.most = geometry::dot(h.across, h.polygon.outer.front());
    for (const Point2 p : h.polygon.outer) {
      h.least = std::min(h.least, geometry::dot(h.across, p));
      h.most = std::max(h.most, geometry::dot(h.across, p));
    }
    const double span = h.most - h.least;
    if (roof == Roof::mono) h.rise = std::min(3.0, 0.25 * span);
    else if (roof != Roof::flat) h.rise = std::min(4.0, 0.4 * span);
    houses.push_back(std::move(h));
  }

  std::vector<House> houses;

 private:
  void draw_height() {
    const bool equal = !houses.empty() && heights_.uniform() < recipe_.equal;
    const double step = heights_.uniform(recipe_.step_least, recipe_.step_most);
    const bool up = heights_.uniform() < 0.5;
    const auto roof = recipe_.roofs[heights_.index(recipe_.roofs.size())];
    if (equal) return;
    roof_ = roof;
    if (eaves_ + step > recipe_.eaves_most) eaves_ -= step;
    else if (eaves_ - step < recipe_.eaves_least || up) eaves_ += step;
    else eaves_ -= step;
  }

  const Recipe& recipe_;
  base::Random plan_, heights_;
  double eaves_ = 10;
  Roof roof_ = Roof::flat;
  std::size_t feature_ = 0;
};

void row(Builder& builder, const Front& front, std::size_t houses, bool with_wings) {
  builder.start_row();
  double at = 0;
  for (std::size_t k = 0; k < houses; ++k) {
    const double to = at + builder.width();
    builder.house(front, at, to, true, with_wings);
    at = to;
  }
}

/// Widths of houses that fill a front exactly: the last takes what is left.
auto widths_filling(Builder& builder, double length, std::size_t houses) -> std::vector<double> {
  std::vector<double> at{0};
  for (std::size_t k = 0; k < houses; ++k) at.push_back(at.back() + builder.width());
  const double stretch = length / at.back();
  for (double& s : at) s = std::round(4 * stretch * s) / 4;
  at.back() = length;
  return at;
}

void ring(Builder& builder, const Recipe& recipe) {
  const double mean = (recipe.width_least + recipe.width_most) / 2, depth = recipe.depth;
  const auto n = static_cast<double>(recipe.houses);
  // The long fronts hold the corners: they have about three houses for every two of the short ones.
  const auto on_long = static_cast<std::size_t>(std::max(2.0, std::round(0.3 * n)));
  const auto on_short = static_cast<std::size_t>(std::max(1.0, std::round(0.2 * n)));
  const double w = std::max(std::round(static_cast<double>(on_long) * mean), 2 * depth + 8);
  const double inner = std::max(std::round(static_cast<double>(on_short) * mean), 8.0);
  const Front fronts[4] = {
      {{0, 0}, {1, 0}}, {{w, depth}, {0, 1}}, {{w, 2 * depth + inner}, {-1, 0}}, {{0, depth + inner}, {0, -1}}};
  builder.start_row();
  for (int side = 0; side < 4; ++side) {
    const bool is_long = side % 2 == 0;
    const double length = is_long ? w : inner;
    const auto at = widths_filling(builder, length, is_long ? on_long : on_short);
    const double clear = is_long ? depth + 7 : 7;  // wings stay out of each other's way in the courtyard's corners
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const bool wing = at[k] >= clear && at[k + 1] <= length - clear && inner >= 14;
      builder.house(fronts[side], at[k], at[k + 1], !is_long || (k > 0 && k + 2 < at.size()), wing);
    }
  }
}

/// Strips across a podium in one direction: low, slab, low, slab … low.
struct Strips {
  std::vector<double> at{0}, rise;
};
auto strips(base::Random& random, std::size_t slabs, const Recipe& recipe) -> Strips {
  Strips made;
  for (std::size_t k = 0; k < 2 * slabs + 1; ++k) {
    made.at.push_back(made.at.back() + std::round(4 * random.uniform(recipe.width_least, recipe.width_most)) / 4);
    made.rise.push_back(k % 2 == 0 ? 0
                                   : std::max(recipe.seen_step, random.uniform(recipe.step_least, recipe.step_most)));
  }
  return made;
}

void towers(Builder& builder, const Recipe& recipe) {
  base::Random random(recipe.seed, 1);
  const auto side = std::max(3.0, std::sqrt(static_cast<double>(recipe.houses)));
  const auto slabs = static_cast<std::size_t>(std::ceil((side - 1) / 2));
  const Strips x = strips(random, slabs, recipe), y = strips(random, slabs, recipe);
  const double podium = random.uniform(recipe.eaves_least, 2 * recipe.eaves_least);
  const Front front{{0, 0}, {1, 0}};
  for (std::size_t j = 0; j < y.rise.size(); ++j)
    for (std::size_t i = 0; i < x.rise.size(); ++i)
      builder.mass(front, front.box(x.at[i], x.at[i + 1], y.at[j], y.at[j + 1]), Roof::flat,
                   podium + x.rise[i] + y.rise[j], 0);
}

void detached(Builder& builder, const Recipe& recipe) {
  const auto a_row = static_cast<std::size_t>(std::ceil(std::sqrt(2.0 * static_cast<double>(recipe.houses))));
  for (std::size_t k = 0, r = 0; k < recipe.houses; ++r) {
    const Front front{{0, static_cast<double>(r) * (recipe.depth + 12)}, {1, 0}};
    double at = 0;
    for (std::size_t c = 0; c < a_row && k < recipe.houses; ++c, ++k) {
      builder.start_row();
      const double to = at + builder.width();
      builder.house(front, at, to, true, true);
      at = to + 4;
    }
  }
}

void grid(Builder& builder, const Recipe& recipe) {
  const auto rows =
      static_cast<std::size_t>(std::max(2.0, std::round(std::sqrt(0.6 * static_cast<double>(recipe.houses)))));
  const std::size_t columns = (recipe.houses + rows - 1) / rows;
  std::vector<double> at;
  for (std::size_t r = 0; r < rows; ++r) {
    const Front front{{0, static_cast<double>(r) * recipe.depth}, {1, 0}};
    if (r % 2 == 0) at = {0};
    if (r % 2 == 0)
      for (std::size_t c = 0; c < columns; ++c) at.push_back(at.back() + builder.width());
    builder.start_row();
    for (std::size_t c = 0; c < columns; ++c) builder.house(front, at[c], at[c + 1], false, false);
  }
}

}  // namespace

auto houses_of(const Recipe& recipe) -> std::vector<House> {
  Builder builder(recipe);
  switch (recipe.kind) {
    case Kind::terrace: row(builder, {{0, 0}, {1, 0}}, recipe.houses, true); break;
    case Kind::perimeter:
    case Kind::courtyard: ring(builder, recipe); break;
    case Kind::towers: towers(builder, recipe); break;
    case Kind::detached: detached(builder, recipe); break;
    case Kind::grid: grid(builder, recipe); break;
  }
  return std::move(builder.houses);
}

}  // namespace mansard::planted
