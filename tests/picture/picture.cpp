#include "mansard/picture/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <png.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "mansard/base/result.hpp"

namespace {

using namespace mansard::picture;
using mansard::geometry::Mesh;
using mansard::geometry::Point3;

constexpr Colour red{200, 30, 30}, blue{30, 30, 200}, green{30, 160, 40}, white{255, 255, 255};

/// A box from one corner to the other, triangles outward.
auto box(Point3 a, Point3 b) -> Mesh {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1) != 0 ? b.x : a.x, (i & 2) != 0 ? b.y : a.y, (i & 4) != 0 ? b.z : a.z});
  for (const auto& [p, q, r, s] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({p, q, r});
    mesh.triangles.push_back({p, r, s});
  }
  return mesh;
}

auto pixel(const Image& image, std::size_t x, std::size_t y) -> Colour {
  const auto* p = image.pixels.data() + 3 * (y * image.width + x);
  return {p[0], p[1], p[2]};
}

auto count(const Image& image, const std::function<bool(Colour)>& is) -> std::size_t {
  std::size_t n = 0;
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = 0; x < image.width; ++x) n += is(pixel(image, x, y)) ? 1 : 0;
  return n;
}

auto reddish(Colour c) -> bool { return c[0] > 1.6 * c[1] && c[0] > 1.6 * c[2]; }
auto bluish(Colour c) -> bool { return c[2] > 1.6 * c[0] && c[2] > 1.6 * c[1]; }
auto greenish(Colour c) -> bool { return c[1] > 1.5 * c[0] && c[1] > 1.5 * c[2]; }
auto orangish(Colour c) -> bool { return c[0] > 200 && c[1] > 90 && c[1] < 190 && c[2] < 110; }

auto view(View::Kind kind, std::size_t width = 160, std::size_t height = 120) -> View {
  View v;
  v.kind = kind;
  v.width = width;
  v.height = height;
  return v;
}

/// A view from a compass direction, nearly level.
auto from(double azimuth, double elevation = 0.2) -> View {
  View v = view(View::Kind::angle);
  v.azimuth = azimuth;
  v.elevation = elevation;
  return v;
}

TEST(Draw, hides_what_lies_behind) {
  // Red in the south, blue of the same size in the north.
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 1, 10}), {red}}, {box({0, 20, 0}, {10, 21, 10}), {blue}}};
  const Image south = draw(layers, {}, from(0, 0.01));
  EXPECT_GT(count(south, reddish), 2000U);
  EXPECT_LT(count(south, bluish), count(south, reddish) / 20);
  const Image north = draw(layers, {}, from(std::numbers::pi, 0.01));
  EXPECT_GT(count(north, bluish), 2000U);
  EXPECT_LT(count(north, reddish), count(north, bluish) / 20);
}

TEST(Draw, stands_clockwise_from_south) {
  // West wall green: a quarter turn clockwise from south is the west.
  Layer layer{box({0, 0, 0}, {10, 10, 10}), std::vector<Colour>(12, red)};
  layer.colours[8] = layer.colours[9] = green;
  const std::vector<Layer> layers{layer};
  EXPECT_GT(count(draw(layers, {}, from(std::numbers::pi / 2)), greenish), 1500U);
  EXPECT_EQ(count(draw(layers, {}, from(-std::numbers::pi / 2)), greenish), 0U);
}

TEST(Draw, looks_from_above_with_north_up_and_east_right) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {4, 4, 1}), {red}}, {box({8, 8, 0}, {12, 12, 1}), {blue}}};
  const Image image = draw(layers, {}, view(View::Kind::above, 120, 120));
  EXPECT_TRUE(reddish(pixel(image, 24, 96))) << "south-west";
  EXPECT_TRUE(bluish(pixel(image, 96, 24))) << "north-east";
  EXPECT_FALSE(reddish(pixel(image, 24, 24)) || bluish(pixel(image, 24, 24)));
}

TEST(Draw, frames_everything_with_a_small_margin) {
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{200, 100}, {100, 200}}) {
    const std::vector<Layer> layers{{box({1000, 2000, 5}, {1010, 2010, 6}), {red}}};
    const Image image = draw(layers, {}, view(View::Kind::above, width, height));
    std::size_t least_x = width, most_x = 0, least_y = height, most_y = 0;
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x)
        if (reddish(pixel(image, x, y))) {
          least_x = std::min(least_x, x), most_x = std::max(most_x, x);
          least_y = std::min(least_y, y), most_y = std::max(most_y, y);
        }
    EXPECT_NEAR(static_cast<double>(most_x - least_x + 1), 92, 2) << "0.92 of the shorter side";
    EXPECT_NEAR(static_cast<double>(most_y - least_y + 1), 92, 2);
    EXPECT_NEAR(static_cast<double>(least_x), static_cast<double>(width - 1 - most_x), 1.5) << "in the middle";
    EXPECT_NEAR(static_cast<double>(least_y), static_cast<double>(height - 1 - most_y), 1.5);
  }
}

TEST(Draw, has_a_background_near_white) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {red}}};
  for (const auto kind : {View::Kind::above, View::Kind::angle}) {
    const Image image = draw(layers, {}, view(kind));
    for (const auto& [x, y] : {std::pair<std::size_t, std::size_t>{0, 0}, {0, 119}, {0, 60}})
      for (const auto channel : pixel(image, x, y)) EXPECT_GE(channel, 225);
  }
}

TEST(Draw, gives_lit_level_surfaces_about_their_own_colour) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 0.1}), {Colour{176, 98, 80}}}};
  const Image image = draw(layers, {}, view(View::Kind::above));
  const Colour middle = pixel(image, 80, 60);
  EXPECT_NEAR(middle[0], 176, 8);
  EXPECT_NEAR(middle[1], 98, 8);
  EXPECT_NEAR(middle[2], 80, 8);
}

TEST(Draw, shades_faces_by_their_direction_and_casts_shadows) {
  // A wide slab with a tower on it: from above the slab is darker south-east of the tower, away from the sun.
  const std::vector<Layer> layers{{box({0, 0, 0}, {40, 40, 1}), {Colour{200, 200, 200}}},
                                  {box({18, 18, 1}, {22, 22, 12}), {red}}};
  const Image image = draw(layers, {}, view(View::Kind::above, 120, 120));
  const auto at = [&](double x, double y) {  // metres to pixels
    const double scale = 0.92 * 120 / 40;
    return pixel(image, static_cast<std::size_t>(60 + (x - 20) * scale),
                 static_cast<std::size_t>(60 - (y - 20) * scale));
  };
  EXPECT_LT(at(24, 16)[0] + 40, at(4, 4)[0]) << "in the shadow";
  EXPECT_GT(at(4, 36)[0], 180) << "in the sun";
}

TEST(Draw, gives_the_same_bytes_with_any_number_of_threads) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {red}}, {box({12, 3, 0}, {20, 9, 5}), {blue}}};
  const std::vector<Lines> lines{
      {{{Point3{0, 0, 0}, Point3{20, 9, 0}}, {Point3{0, 0, 10}, Point3{20, 0, 0}}}, footprint_orange, 2}};
  mansard::base::limit_threads(1);
  const Image one = draw(layers, lines, view(View::Kind::angle));
  mansard::base::limit_threads(2);
  const Image two = draw(layers, lines, view(View::Kind::angle));
  mansard::base::limit_threads(0);
  const Image all = draw(layers, lines, view(View::Kind::angle));
  EXPECT_EQ(one.pixels, two.pixels);
  EXPECT_EQ(one.pixels, all.pixels);
  EXPECT_EQ(*png(one), *png(two));
}

TEST(Draw, several_views_are_as_one_by_one) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {red}}, {box({12, 3, 0}, {20, 9, 5}), {blue}}};
  const std::vector<Lines> lines{{{{Point3{0, 0, 10}, Point3{20, 0, 0}}}, footprint_orange, 2}};
  const std::vector<View> views{view(View::Kind::above), from(0.4), view(View::Kind::angle, 61, 47)};
  const auto images = draw_views(layers, lines, views);
  ASSERT_EQ(images.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(images[i].pixels, draw(layers, lines, views[i]).pixels) << i;
  EXPECT_TRUE(draw_views(layers, lines, {}).empty());
}

TEST(Draw, is_the_same_wherever_the_origin_is) {
  const auto at = [](Point3 o) {
    const std::vector<Layer> layers{{box(o, o + Point3{8, 8, 8}), {red}}};
    return draw(layers, {}, view(View::Kind::angle));
  };
  const Image here = at({0, 0, 0}), there = at({4096, -2048, 64});
  std::size_t different = 0;
  for (std::size_t i = 0; i < here.pixels.size(); ++i)
    different += std::abs(here.pixels[i] - there.pixels[i]) > 6 ? 1 : 0;
  EXPECT_LT(different, here.pixels.size() / 200);
}

TEST(Draw, colours_triangle_by_triangle_or_all_alike) {
  Layer layer{box({0, 0, 0}, {10, 10, 1}), std::vector<Colour>(12, red)};
  layer.colours[3] = blue;  // half of the top
  const Image image = draw(std::vector<Layer>{layer}, {}, view(View::Kind::above, 120, 120));
  const auto reds = static_cast<double>(count(image, reddish)), blues = static_cast<double>(count(image, bluish));
  EXPECT_NEAR(reds / blues, 1, 0.05);
}

TEST(Draw, smooths_edges) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {red}}};
  const Image image = draw(layers, {}, from(0.6, 0.7));
  std::set<Colour> shades;
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = 1; x < image.width; ++x)
      if (reddish(pixel(image, x, y)) != reddish(pixel(image, x - 1, y))) shades.insert(pixel(image, x, y));
  EXPECT_GT(shades.size(), 20U) << "many mixtures of box and paper, not a staircase of two colours";
}

TEST(Draw, takes_no_layers_empty_layers_and_lines_alone) {
  const Image blank = draw({}, {}, view(View::Kind::angle, 40, 30));
  EXPECT_EQ(blank.pixels.size(), 3U * 40 * 30);
  EXPECT_EQ(count(blank, [&](Colour c) { return c == pixel(blank, 0, 0); }), 40U * 30);
  const Image empty = draw(std::vector<Layer>{{}}, {}, view(View::Kind::angle, 40, 30));
  EXPECT_EQ(empty.pixels, blank.pixels);
  const std::vector<Lines> lines{{{{Point3{0, 0, 0}, Point3{10, 0, 0}}}, footprint_orange, 3}};
  EXPECT_GT(count(draw({}, lines, view(View::Kind::above, 40, 30)), orangish), 60U);
}

TEST(Draw, endures_triangles_without_area) {
  Layer layer{box({0, 0, 0}, {10, 10, 10}), {red}};
  layer.mesh.triangles.push_back({0, 0, 7});
  layer.mesh.triangles.push_back({3, 3, 3});
  EXPECT_GT(count(draw(std::vector<Layer>{layer}, {}, view(View::Kind::angle)), reddish), 1000U);
}

TEST(Draw, stops_when_asked_to) {
  mansard::base::Cancel cancel;
  cancel.request();
  mansard::base::Run run;
  run.cancel = &cancel;
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {red}}};
  EXPECT_EQ(draw(layers, {}, view(View::Kind::angle), run).pixels.size(), 3U * 160 * 120);
}

/// A street of towers on a field of small squares, with lines on it: shadows fall from one piece to another.
struct Street {
  std::vector<Layer> layers;
  std::vector<Lines> lines{{{}, footprint_orange, 2}};
  Street() {
    Layer field;
    for (std::uint32_t y = 0; y <= 40; ++y)
      for (std::uint32_t x = 0; x <= 40; ++x)
        field.mesh.vertices.push_back({2.5 * x, 2.5 * y, 0.3 * static_cast<double>((7 * x + 3 * y) % 5)});
    for (std::uint32_t y = 0; y < 40; ++y)
      for (std::uint32_t x = 0; x < 40; ++x) {
        const std::uint32_t v = 41 * y + x;
        field.mesh.triangles.push_back({v, v + 1, v + 42});
        field.mesh.triangles.push_back({v, v + 42, v + 41});
      }
    layers.push_back(field);
    for (int i = 0; i < 9; ++i) {
      const double x = 8 + 30.0 * (i % 3), y = 8 + 30.0 * (i / 3), z = 6 + 4.0 * i;
      layers.push_back({box({x, y, 0}, {x + 14, y + 11, z}), {i % 2 == 0 ? red : blue}, {}});
      lines.front().segments.push_back({Point3{x, y, z}, Point3{x + 14, y, z}});
      lines.front().segments.push_back({Point3{x - 3, y + 20, 1}, Point3{x + 20, y + 20, 1}});
    }
    layers.back().picture = [](std::size_t, Point3 p) {
      return p.z > 3 ? std::optional(green) : std::nullopt;  // a sign on the last tower
    };
  }
  /// In `columns` × `columns` pieces, by the middles of the triangles; the last has nothing.
  [[nodiscard]] auto pieces(int columns) const -> Pieces {
    return {static_cast<std::size_t>(columns * columns + 1),
            [this, columns](std::size_t piece) -> mansard::base::Result<std::vector<Layer>> {
              std::vector<Layer> out;
              for (const Layer& layer : layers) {
                Layer own{{layer.mesh.vertices, {}}, layer.colours, layer.picture};
                for (const auto& t : layer.mesh.triangles) {
                  const Point3 middle =
                      (1.0 / 3) * (layer.mesh.vertices[t[0]] + layer.mesh.vertices[t[1]] + layer.mesh.vertices[t[2]]);
                  const int column = static_cast<int>(middle.x / 101 * columns),
                            row = static_cast<int>(middle.y / 101 * columns);
                  if (static_cast<std::size_t>(row * columns + column) == piece) own.mesh.triangles.push_back(t);
                }
                out.push_back(own);
              }
              return out;
            }};
  }
};

TEST(Draw, in_pieces_is_as_a_whole) {
  const Street street;
  const std::vector<View> views{view(View::Kind::above), from(0.4, 0.5), view(View::Kind::angle, 301, 217)};
  const auto whole = draw_views(street.layers, street.lines, views);
  for (const int columns : {1, 2, 5}) {
    const auto images = draw_views(street.pieces(columns), street.lines, views);
    ASSERT_TRUE(images);
    ASSERT_EQ(images->size(), views.size());
    for (std::size_t v = 0; v < views.size(); ++v) {
      const auto& pixels = (*images)[v].pixels;
      ASSERT_EQ(pixels.size(), whole[v].pixels.size());
      std::size_t different = 0;
      for (std::size_t i = 0; i < pixels.size(); ++i) different += std::abs(pixels[i] - whole[v].pixels[i]) > 3 ? 1 : 0;
      EXPECT_LT(different, pixels.size() / 300) << columns << " " << v;
    }
  }
}

TEST(Draw, in_pieces_gives_the_same_bytes_with_any_number_of_threads) {
  const Street street;
  const std::vector<View> views{view(View::Kind::angle)};
  mansard::base::limit_threads(1);
  const auto one = draw_views(street.pieces(3), street.lines, views);
  mansard::base::limit_threads(2);
  const auto two = draw_views(street.pieces(3), street.lines, views);
  mansard::base::limit_threads(0);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->front().pixels, two->front().pixels);
}

TEST(Draw, in_pieces_fails_where_a_piece_cannot_be_loaded) {
  const Street street;
  // At first all goes well: the pieces are gone through several times.
  for (const int good : {0, 4, 9, 11, 17, 21}) {
    int loads = 0;
    auto pieces = street.pieces(2);
    const auto load = pieces.load;
    pieces.load = [&](std::size_t piece) -> mansard::base::Result<std::vector<Layer>> {
      if (loads++ == good) return mansard::base::error("file-write", "gone");
      return load(piece);
    };
    const auto images = draw_views(pieces, street.lines, std::vector<View>{view(View::Kind::angle)});
    ASSERT_FALSE(images) << good;
    EXPECT_EQ(images.error().code, "file-write");
  }
}

TEST(Draw, takes_no_pieces) {
  const Pieces none;
  const auto images = draw_views(none, {}, std::vector<View>{view(View::Kind::angle, 40, 30)});
  ASSERT_TRUE(images);
  EXPECT_EQ(images->front().pixels, draw({}, {}, view(View::Kind::angle, 40, 30)).pixels);
}

TEST(Lines, are_hidden_behind_surfaces_and_shown_in_front) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {blue}}};
  const auto oranges = [&](double y) {
    const std::vector<Lines> lines{{{{Point3{1, y, 5}, Point3{9, y, 5}}}, footprint_orange, 2}};
    return count(draw(layers, lines, from(0, 0.01)), orangish);
  };
  EXPECT_GT(oranges(-0.5), 60U) << "before the south wall";
  EXPECT_GT(oranges(0.0), 60U) << "on it";
  EXPECT_GT(oranges(0.08), 60U) << "hidden by less than 10 cm";
  EXPECT_EQ(oranges(0.5), 0U) << "inside";
  EXPECT_EQ(oranges(11), 0U) << "behind";
}

TEST(Lines, show_their_visible_part_only) {
  // Half of the line passes behind the box.
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {blue}}};
  const std::vector<Lines> lines{{{{Point3{-10, 12, 5}, Point3{10, 12, 5}}}, footprint_orange, 2}};
  const Image image = draw(layers, lines, from(0, 0.01));
  std::size_t least = image.width, most = 0;
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = 0; x < image.width; ++x)
      if (orangish(pixel(image, x, y))) least = std::min(least, x), most = std::max(most, x);
  EXPECT_LT(least, 10U);
  EXPECT_NEAR(static_cast<double>(most), 80, 3) << "up to the middle of the picture";
}

TEST(Lines, along_the_foot_of_walls_show_all_around_from_above) {
  const std::vector<Layer> layers{{box({0, 0, 0}, {10, 10, 10}), {blue}}};
  for (const auto& [from, to] : {std::pair<Point3, Point3>{{0, 0, 0}, {10, 0, 0}},
                                 {{10, 0, 0}, {10, 10, 0}},
                                 {{10, 10, 0}, {0, 10, 0}},
                                 {{0, 10, 0}, {0, 0, 0}}}) {
    const std::vector<Lines> lines{{{{from, to}}, footprint_orange, 3}};
    EXPECT_GT(count(draw(layers, lines, view(View::Kind::above, 120, 120)), orangish), 200U);
  }
}

TEST(Lines, are_as_wide_as_asked) {
  for (const double width : {1.0, 2.0, 5.0}) {
    const std::vector<Lines> lines{{{{Point3{0, 0, 0}, Point3{100, 0, 0}}}, Colour{0, 0, 0}, width}};
    const Image image = draw({}, lines, view(View::Kind::above, 101, 51));
    double ink = 0;  // coverage down the middle column, in linear light
    for (std::size_t y = 0; y < image.height; ++y) {
      const double v = pixel(image, 50, y)[0] / 255.0, paper = pixel(image, 0, 0)[0] / 255.0;
      const auto light = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
      ink += 1 - light(v) / light(paper);
    }
    EXPECT_NEAR(ink, width, 0.15);
  }
}

// ---- error maps -----------------------------------------------------------------------------------------------------

constexpr Colour deepest_blue{20, 60, 140}, deepest_red{150, 16, 38}, no_value{206, 206, 206};

/// The rectangle of pixels that have a colour, and how many; runs of fewer than 12 in a row are letters' soft edges.
struct Extent {
  std::size_t left = ~0UL, right = 0, top = ~0UL, bottom = 0, pixels = 0;
};
auto extent(const Image& image, Colour colour, std::size_t from_x = 0, std::size_t to_x = ~0UL) -> Extent {
  Extent e;
  const std::size_t end = std::min(image.width, to_x);
  for (std::size_t y = 0; y < image.height; ++y)
    for (std::size_t x = from_x, run = 0; x < end; x += run + 1, run = 0) {
      while (x + run < end && pixel(image, x + run, y) == colour) ++run;
      if (run < 12) continue;
      e.left = std::min(e.left, x), e.right = std::max(e.right, x + run - 1);
      e.top = std::min(e.top, y), e.bottom = std::max(e.bottom, y);
      e.pixels += run;
    }
  return e;
}

TEST(ErrorMap, is_blue_white_and_red_at_the_known_values) {
  // North row: red, grey. South row: blue, white.
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{-2, 0, 2, nan};
  const Image image = error_map(values, 2, 2, 2, "");
  const Extent grey = extent(image, no_value);
  EXPECT_EQ(grey.pixels, 400U * 400U) << "two cells a side over at least 800 pixels";
  const Extent south = extent(image, deepest_blue, 0, grey.left), north = extent(image, deepest_red, 0, grey.left);
  EXPECT_EQ(south.pixels, 400U * 400U);
  EXPECT_EQ(north.pixels, 400U * 400U);
  EXPECT_EQ(north.bottom + 1, south.top) << "south is below";
  EXPECT_EQ(pixel(image, grey.left + 200, south.top + 200), white) << "0 is white";
}

TEST(ErrorMap, keeps_its_scale_whatever_the_values) {
  const auto colour_of = [](float value, double limit) {
    const Image image = error_map(std::vector<float>(4, value), 2, 2, limit, "");
    std::map<Colour, std::size_t> counts;  // the commonest colour but white is the cell's
    for (std::size_t y = 0; y < image.height; ++y)
      for (std::size_t x = 0; x < image.width; ++x)
        if (pixel(image, x, y) != white) ++counts[pixel(image, x, y)];
    return std::max_element(counts.begin(), counts.end(), [](auto& a, auto& b) { return a.second < b.second; })->first;
  };
  EXPECT_EQ(colour_of(2, 2), deepest_red);
  EXPECT_EQ(colour_of(50, 2), deepest_red) << "beyond the limit";
  EXPECT_EQ(colour_of(-50, 2), deepest_blue);
  EXPECT_EQ(colour_of(std::numeric_limits<float>::infinity(), 2), deepest_red);
  EXPECT_EQ(colour_of(1, 2), colour_of(0.5, 1)) << "a share of the limit";
  EXPECT_NE(colour_of(1, 2), colour_of(2, 2));
  EXPECT_EQ(colour_of(std::numeric_limits<float>::quiet_NaN(), 2), no_value);
}

TEST(ErrorMap, grows_redder_upwards_and_bluer_downwards_without_a_step) {
  std::vector<float> ramp;
  for (int i = -400; i <= 400; ++i) ramp.push_back(static_cast<float>(i) / 400);
  const Image image = error_map(ramp, ramp.size(), 1, 1, "");
  std::size_t row = 0, left = 0;  // the map starts at the first pixel of the deepest blue that is not in the bar
  while (pixel(image, left, row) != deepest_blue)
    row = left + 1 < image.width ? row : row + 1, left = (left + 1) % image.width;
  Colour before = pixel(image, left, row);
  for (std::size_t i = 1; i < ramp.size(); ++i) {
    const Colour now = pixel(image, left + i, row);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(now[c] - before[c]), 4);
    if (i <= 400) {
      EXPECT_GE(now[0], before[0]);
    } else {
      EXPECT_LE(now[2], before[2]);
    }
    before = now;
  }
}

TEST(ErrorMap, draws_a_legend_and_a_title) {
  const std::vector<float> values(100 * 50, std::numeric_limits<float>::quiet_NaN());
  const Image plain = error_map(values, 100, 50, 1, "");
  const Image titled = error_map(values, 100, 50, 1, "Vertical error, model − mesh");
  EXPECT_EQ(plain.width, titled.width);
  const Extent map = extent(plain, no_value);
  EXPECT_EQ(map.right - map.left + 1, 800U);
  EXPECT_EQ(map.bottom - map.top + 1, 400U);
  const auto dark = [](Colour c) { return c[0] < 120 && c[1] < 120 && c[2] < 120; };
  const auto darks = [&](const Image& image, std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1) {
    std::size_t n = 0;
    for (std::size_t y = y0; y < y1; ++y)
      for (std::size_t x = x0; x < x1; ++x) n += dark(pixel(image, x, y)) ? 1 : 0;
    return n;
  };
  EXPECT_EQ(darks(plain, 0, plain.width, 0, map.top - 20), 0U);
  EXPECT_GT(darks(titled, 0, plain.width, 0, map.top - 20), 300U) << "letters";
  EXPECT_GT(extent(plain, deepest_red, map.right + 1).pixels, 0U) << "the bar's upper end";
  EXPECT_GT(extent(plain, deepest_blue, map.right + 1).pixels, 0U) << "the bar's lower end";
  EXPECT_LT(extent(plain, deepest_red, map.right + 1).top, extent(plain, deepest_blue, map.right + 1).top);
  const std::size_t labels = extent(plain, deepest_red, map.right + 1).right + 5;
  EXPECT_GT(darks(plain, labels, plain.width, 0, plain.height), 100U) << "numbers";
  EXPECT_NE(error_map(values, 100, 50, 2, "").pixels, plain.pixels) << "the numbers say the limit";
}

TEST(ErrorMap, makes_room_for_a_long_title_and_takes_any_shape) {
  const std::vector<float> values(600, 0);
  const std::string title(80, 'W');
  EXPECT_GT(error_map(values, 1, 600, 1, title).width, error_map(values, 1, 600, 1, "").width);
  for (const auto& [columns, rows] : {std::pair<std::size_t, std::size_t>{600, 1}, {1, 600}, {20, 30}, {0, 0}}) {
    const Image image = error_map(std::span(values).first(columns * rows), columns, rows, 1, "é \xFF ∑");
    EXPECT_EQ(image.pixels.size(), 3 * image.width * image.height);
    EXPECT_TRUE(png(image));
  }
}

TEST(ErrorMap, is_not_enlarged_beyond_need) {
  const std::vector<float> values(1500 * 3, std::numeric_limits<float>::quiet_NaN());
  const Extent map = extent(error_map(values, 1500, 3, 1, ""), no_value);
  EXPECT_EQ(map.right - map.left + 1, 1500U);
  EXPECT_EQ(map.bottom - map.top + 1, 3U);
}

// ---- images and files -----------------------------------------------------------------------------------------------

auto plain_image(std::size_t width, std::size_t height, Colour colour) -> Image {
  Image image{width, height, {}};
  for (std::size_t i = 0; i < width * height; ++i)
    image.pixels.insert(image.pixels.end(), colour.begin(), colour.end());
  return image;
}

TEST(Beside, puts_images_in_a_row_on_white) {
  const std::vector<Image> images{plain_image(10, 20, red), plain_image(30, 5, blue)};
  const Image row = beside(images);
  EXPECT_EQ(row.height, 20U);
  ASSERT_GT(row.width, 40U);
  EXPECT_EQ(pixel(row, 9, 19), red);
  EXPECT_EQ(pixel(row, 10, 0), white);
  EXPECT_EQ(pixel(row, row.width - 1, 4), blue);
  EXPECT_EQ(pixel(row, row.width - 30, 0), blue);
  EXPECT_EQ(pixel(row, row.width - 31, 0), white);
  EXPECT_EQ(pixel(row, row.width - 1, 5), white);
  EXPECT_EQ(beside({}).pixels.size(), 0U);
  EXPECT_EQ(beside(std::vector<Image>{images[0]}).pixels, images[0].pixels);
}

auto decoded(const std::string& bytes) -> Image {
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&reader, bytes.data(), bytes.size()), 0) << reader.message;
  EXPECT_EQ(reader.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  Image image{reader.width, reader.height, std::vector<std::uint8_t>(3UL * reader.width * reader.height)};
  reader.format = PNG_FORMAT_RGB;
  EXPECT_NE(png_image_finish_read(&reader, nullptr, image.pixels.data(), 0, nullptr), 0) << reader.message;
  return image;
}

TEST(Png, comes_back_with_the_same_pixels) {
  mansard::base::Random random(5);
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{1, 1}, {7, 3}, {64, 200}}) {
    Image image{width, height, std::vector<std::uint8_t>(3 * width * height)};
    for (auto& byte : image.pixels) byte = static_cast<std::uint8_t>(random.index(256));
    const auto bytes = png(image);
    ASSERT_TRUE(bytes);
    const Image back = decoded(*bytes);
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.pixels, image.pixels);
    EXPECT_EQ(*png(image), *bytes) << "the same bytes every time";
  }
}

TEST(Png, holds_no_time_and_no_text) {
  const std::string bytes = *png(plain_image(4, 4, red));
  std::set<std::string> chunks;
  for (std::size_t at = 8; at + 8 <= bytes.size();) {
    std::array<unsigned char, 4> size{};
    std::memcpy(size.data(), bytes.data() + at, 4);
    chunks.insert(bytes.substr(at + 4, 4));
    at += 12 + (static_cast<std::size_t>(size[0]) << 24U) + (static_cast<std::size_t>(size[1]) << 16U) +
          (static_cast<std::size_t>(size[2]) << 8U) + size[3];
  }
  EXPECT_EQ(chunks.count("tIME"), 0U);
  EXPECT_EQ(chunks.count("tEXt"), 0U);
  EXPECT_EQ(chunks.count("IHDR"), 1U);
  EXPECT_EQ(chunks.count("IEND"), 1U);
}

TEST(Png, refuses_images_without_pixels_or_with_the_wrong_number) {
  EXPECT_EQ(png(Image{}).error().code, "picture-png");
  EXPECT_EQ(png(Image{2, 2, std::vector<std::uint8_t>(11)}).error().code, "picture-png");
  std::set<std::string> known;
  for (const auto& code : codes()) known.insert(code.code);
  EXPECT_TRUE(known.contains("picture-png"));
}

}  // namespace
