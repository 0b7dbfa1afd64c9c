#include "mansard/picture/detail/lettering.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "mansard/base/text.hpp"

namespace mansard::picture::detail {
namespace {

/// Capitals are 12 units tall, small letters 8, descenders −4. Strokes are separated by ';' and are points "x,y"; one
/// that begins with '~' is a curve, and is closed when it ends where it began.
struct Drawing {
  char32_t code;
  double width;
  const char* strokes;
};

constexpr Drawing drawings[] = {
    {U' ', 3, ""},
    {U'!', 1, "0.5,12 0.5,4;0.5,0 0.5,0"},
    {U'"', 3, "0,12 0,9;3,12 3,9"},
    {U'#', 8, "2,0 3.5,12;5,0 6.5,12;0,4 8,4;0.5,8 8.5,8"},
    {U'$', 7, "~7,9 7,11 0,11 0,6.5 3.5,6 7,5.5 7,1 0,1 0,3;3.5,13 3.5,-1"},
    {U'%', 9, "8,12 1,0;~2,12 4,12 4,8 0,8 0,12 2,12;~7,4 9,4 9,0 5,0 5,4 7,4"},
    {U'&', 9, "~9,0 2,8 1.5,12 5.5,12 5.5,8 0,6 0,0 6,0 8.5,5"},
    {U'\'', 1, "0.5,12 0.5,9"},
    {U'(', 3, "~3,14 0,10 0,2 3,-2"},
    {U')', 3, "~0,14 3,10 3,2 0,-2"},
    {U'*', 6, "3,12 3,6;0.4,10.5 5.6,7.5;0.4,7.5 5.6,10.5"},
    {U'+', 7, "3.5,2.5 3.5,9.5;0,6 7,6"},
    {U',', 1, "1,0.3 0,-2.5"},
    {U'-', 5, "0,5 5,5"},
    {U'.', 1, "0.5,0 0.5,0"},
    {U'/', 6, "0,-1 6,13"},
    {U'0', 7, "~3.5,12 7,12 7,0 0,0 0,12 3.5,12"},
    {U'1', 4, "0,9.5 3,12 3,0"},
    {U'2', 7, "~0,9 0,12 7,12.5 7,7 3,4 0,0;0,0 7,0"},
    {U'3', 7, "~0,10 0.5,12 6.5,12 6.5,6.3 2.5,6.3;~2.5,6.3 7,6.3 7,0 0,0 0,2.4"},
    {U'4', 8, "6,0 6,12 0,3.5 8,3.5"},
    {U'5', 7, "6.5,12 0.8,12 0.4,6.6;~0.4,6.6 2,7.7 7,8 7,0 0,0 0,2"},
    {U'6', 7, "~6,11 5,12.3 0,12.5 0,4;~3.5,7.5 7,7.5 7,0 0,0 0,7.5 3.5,7.5"},
    {U'7', 7, "0,12 7,12 2.5,0"},
    {U'8', 7, "~3.5,12 6.6,12 6.6,6.4 0.4,6.4 0.4,12 3.5,12;~3.5,6.4 7,6.4 7,0 0,0 0,6.4 3.5,6.4"},
    {U'9', 7, "~1,1 2,-0.3 7,-0.5 7,8;~3.5,4.5 0,4.5 0,12 7,12 7,4.5 3.5,4.5"},
    {U':', 1, "0.5,7 0.5,7;0.5,0.5 0.5,0.5"},
    {U';', 1, "1,7 1,7;1,0.5 0,-2.5"},
    {U'<', 7, "7,10.5 0,6 7,1.5"},
    {U'=', 7, "0,8 7,8;0,4 7,4"},
    {U'>', 7, "0,10.5 7,6 0,1.5"},
    {U'?', 6, "~0,9.5 0,12 6,12.5 6,8 3,7 3,4;3,0 3,0"},
    {U'@', 11, "~8,4 4,2 3,8 8,8.5 8,4 11,2 11,12 0,13 0,-1 7,-2 9,-1"},
    {U'A', 9, "0,0 4.5,12 9,0;1.5,4 7.5,4"},
    {U'B', 7.5, "0,0 0,12;~0,12 3,12 7,12.4 7,6.4 3,6.4 0,6.4;~0,6.4 3,6.4 7.5,6.6 7.5,-0.2 3,0 0,0"},
    {U'C', 8, "~8,9.5 7,12.6 0,13 0,-1 7,-0.6 8,2.5"},
    {U'D', 8.5, "0,0 0,12;~0,12 3,12 8.5,12.5 8.5,-0.5 3,0 0,0"},
    {U'E', 7, "7,12 0,12 0,0 7,0;0,6.4 5.8,6.4"},
    {U'F', 7, "7,12 0,12 0,0;0,6.2 5.6,6.2"},
    {U'G', 8.5, "~8.2,9.5 7,12.6 0,13 0,-1 8.5,-1 8.5,5;8.5,5.5 5,5.5"},
    {U'H', 8, "0,0 0,12;8,0 8,12;0,6.3 8,6.3"},
    {U'I', 1, "0.5,0 0.5,12"},
    {U'J', 5.5, "5.5,12 5.5,4;~5.5,4 5.5,-0.5 0,-0.7 0,2.5"},
    {U'K', 8, "0,0 0,12;7.5,12 0,4.8;2.8,7.5 8,0"},
    {U'L', 6.5, "0,12 0,0 6.5,0"},
    {U'M', 10, "0,0 0,12 5,3 10,12 10,0"},
    {U'N', 8.5, "0,0 0,12 8.5,0 8.5,12"},
    {U'O', 9, "~4.5,12 9,12 9,0 0,0 0,12 4.5,12"},
    {U'P', 7.5, "0,0 0,12;~0,12 3,12 7.5,12.4 7.5,5.2 3,5.6 0,5.6"},
    {U'Q', 9, "~4.5,12 9,12 9,0 0,0 0,12 4.5,12;5.5,3 9,-1"},
    {U'R', 8, "0,0 0,12;~0,12 3,12 7.5,12.4 7.5,5.6 3,6 0,6;4,6 8,0"},
    {U'S', 7.5, "~7.2,9.6 6.5,12.5 0.3,12.8 0.3,7 3.7,6.3 7.5,5.4 7.5,-0.8 0.8,-0.6 0,2.6"},
    {U'T', 8, "4,0 4,12;0,12 8,12"},
    {U'U', 8, "0,12 0,5;8,12 8,5;~0,5 0,0 4,0 8,0 8,5"},
    {U'V', 9, "0,12 4.5,0 9,12"},
    {U'W', 12, "0,12 3,0 6,11 9,0 12,12"},
    {U'X', 8, "0,0 8,12;0,12 8,0"},
    {U'Y', 8, "0,12 4,6 8,12;4,6 4,0"},
    {U'Z', 8, "0,12 8,12 0,0 8,0"},
    {U'[', 3, "3,14 0,14 0,-2 3,-2"},
    {U'\\', 6, "0,13 6,-1"},
    {U']', 3, "0,14 3,14 3,-2 0,-2"},
    {U'^', 6, "0,9 3,12 6,9"},
    {U'_', 7, "0,-2 7,-2"},
    {U'`', 2, "0,12 2,10"},
    {U'a', 6.5, "6.5,8 6.5,0;~6.5,4.5 6.5,8 3.5,8 0,8 0,0 3.5,0 6.5,0 6.5,4.5"},
    {U'b', 6.5, "0,12 0,0;~0,4.5 0,8 3.5,8 6.5,8 6.5,0 3.5,0 0,0 0,4.5"},
    {U'c', 6, "~6,6.3 5.5,8.2 0,8.6 0,-0.6 5.5,-0.2 6,1.7"},
    {U'd', 6.5, "6.5,12 6.5,0;~6.5,4.5 6.5,8 3.5,8 0,8 0,0 3.5,0 6.5,0 6.5,4.5"},
    {U'e', 6.5, "0.3,4.2 6.5,4.2;~6.5,4.2 6.5,8.4 0,8.8 0,-0.8 5.6,-0.3 6.2,1.6"},
    {U'f', 4.5, "~4.5,11.8 1.8,12.6 1.8,9;1.8,9 1.8,0;0,8 4.2,8"},
    {U'g', 6.5, "6.5,8 6.5,-1;~6.5,-1 6.5,-4.3 1,-4.4 0.4,-2.5;~6.5,4.5 6.5,8 3.5,8 0,8 0,0 3.5,0 6.5,0 6.5,4.5"},
    {U'h', 6, "0,12 0,0;~0,5 0.5,8.3 6,9 6,5;6,5 6,0"},
    {U'i', 1, "0.5,8 0.5,0;0.5,11 0.5,11"},
    {U'j', 3, "2.5,8 2.5,-1;~2.5,-1 2.5,-4.2 0,-3.8;2.5,11 2.5,11"},
    {U'k', 6, "0,12 0,0;5.5,8 0,3;2,4.8 6,0"},
    {U'l', 1, "0.5,12 0.5,0"},
    {U'm', 10.5, "0,8 0,0;~0,5 0.5,8.3 5.2,9 5.2,5;5.2,5 5.2,0;~5.2,5 5.7,8.3 10.5,9 10.5,5;10.5,5 10.5,0"},
    {U'n', 6, "0,8 0,0;~0,5 0.5,8.3 6,9 6,5;6,5 6,0"},
    {U'o', 7, "~3.5,8 7,8 7,0 0,0 0,8 3.5,8"},
    {U'p', 6.5, "0,8 0,-4;~0,4.5 0,8 3.5,8 6.5,8 6.5,0 3.5,0 0,0 0,4.5"},
    {U'q', 6.5, "6.5,8 6.5,-4;~6.5,4.5 6.5,8 3.5,8 0,8 0,0 3.5,0 6.5,0 6.5,4.5"},
    {U'r', 4, "0,8 0,0;~0,4.5 0.5,8.2 4,8"},
    {U's', 5.5, "~5.3,6.4 4.9,8.3 0.2,8.5 0.2,4.8 2.7,4.2 5.5,3.6 5.5,-0.4 0.5,-0.4 0,1.7"},
    {U't', 4.5, "1.8,11 1.8,3;~1.8,3 1.8,-0.4 4.5,0.2;0,8 4.3,8"},
    {U'u', 6, "0,8 0,3;~0,3 0,-1 5.5,-0.3 6,3;6,8 6,0"},
    {U'v', 6.5, "0,8 3.25,0 6.5,8"},
    {U'w', 10, "0,8 2.5,0 5,7.5 7.5,0 10,8"},
    {U'x', 6, "0,0 6,8;0,8 6,0"},
    {U'y', 6.5, "0,8 3.25,0;~6.5,8 3.25,0 2,-4 0,-3.8"},
    {U'z', 6, "0,8 6,8 0,0 6,0"},
    {U'{', 3, "~3,14 1.2,14 1.8,6.5 0,6;~0,6 1.8,5.5 1.2,-2 3,-2"},
    {U'|', 1, "0.5,14 0.5,-2"},
    {U'}', 3, "~0,14 1.8,14 1.2,6.5 3,6;~3,6 1.2,5.5 1.8,-2 0,-2"},
    {U'~', 7, "~0,5 1.5,7.5 5,3.5 7,6.5"},
    {U'°', 4, "~2,12.6 4,12.6 4,8.6 0,8.6 0,12.6 2,12.6"},
    {U'±', 7, "3.5,4 3.5,11;0,7.5 7,7.5;0,1.5 7,1.5"},
    {U'²', 4, "~0,11 0,12.6 4,12.8 4,10 1.5,8.3 0,6.5;0,6.5 4,6.5"},
    {U'·', 1, "0.5,5.5 0.5,5.5"},
    {U'×', 6, "0.5,3 5.5,8;0.5,8 5.5,3"},
    {U'–', 7, "0,5 7,5"},
    {U'—', 11, "0,5 11,5"},
    {U'−', 7, "0,6 7,6"},
    {U'→', 9, "0,5 9,5;6,8 9,5 6,2"},
};
constexpr Drawing box{U'\0', 7, "0,0 7,0 7,12 0,12 0,0"};
constexpr double gap = 2.6;  ///< between characters, units
constexpr double capital = 12;

struct Glyph {
  double width = 0;
  std::vector<std::vector<Spot>> strokes;
};

/// Cuts the corners of a polyline (Chaikin 1974): towards a quadratic spline that keeps the ends.
auto curved(std::vector<Spot> points) -> std::vector<Spot> {
  const bool closed = points.front().x == points.back().x && points.front().y == points.back().y;
  const auto between = [](Spot a, Spot b, double t) { return Spot{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; };
  for (int round = 0; round < 3; ++round) {
    std::vector<Spot> finer;
    if (!closed) finer.push_back(points.front());
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      finer.push_back(between(points[i], points[i + 1], 0.25));
      finer.push_back(between(points[i], points[i + 1], 0.75));
    }
    finer.push_back(closed ? finer.front() : points.back());
    points = std::move(finer);
  }
  return points;
}

auto glyph_of(const Drawing& drawing) -> Glyph {
  Glyph glyph{drawing.width, {}};
  std::string_view rest = drawing.strokes;
  while (!rest.empty()) {
    std::string_view stroke = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), stroke.size() + 1));
    const bool curve = stroke.starts_with('~');
    if (curve) stroke.remove_prefix(1);
    std::vector<Spot> points;
    while (!stroke.empty()) {
      const std::string_view pair = stroke.substr(0, stroke.find(' '));
      stroke.remove_prefix(std::min(stroke.size(), pair.size() + 1));
      const auto comma = pair.find(',');
      const auto x = base::to_number(pair.substr(0, comma)), y = base::to_number(pair.substr(comma + 1));
      if (x && y) points.push_back({*x, *y});
    }
    glyph.strokes.push_back(curve ? curved(std::move(points)) : std::move(points));
  }
  return glyph;
}

auto glyph_for(char32_t code) -> const Glyph& {
  static const auto all = [] {
    std::map<char32_t, Glyph> glyphs;
    for (const Drawing& drawing : drawings) glyphs.emplace(drawing.code, glyph_of(drawing));
    return glyphs;
  }();
  static const Glyph unknown = glyph_of(box);
  const auto found = all.find(code);
  return found == all.end() ? unknown : found->second;
}

/// The characters of UTF-8; a byte that starts none counts as an unknown character.
auto characters(std::string_view text) -> std::vector<char32_t> {
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    char32_t code = length == 1 ? lead : lead & (0x7FU >> length);
    for (std::size_t k = 1; k < length && i + k < text.size(); ++k)
      code = (code << 6U) | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    out.push_back(code);
    i += length;
  }
  return out;
}

}  // namespace

auto text_width(std::string_view text, double height) -> double {
  double units = 0;
  for (const char32_t code : characters(text)) units += glyph_for(code).width + gap;
  return std::max(0.0, units - gap) * height / capital;
}

void write_text(Ink& ink, std::string_view text, Spot at, double height) {
  const double unit = height / capital, weight = std::max(1.1, 0.115 * height);
  for (const char32_t code : characters(text)) {
    const Glyph& glyph = glyph_for(code);
    for (const auto& stroke : glyph.strokes)
      for (std::size_t i = 0; i < std::max<std::size_t>(1, stroke.size() - 1); ++i) {
        const Spot a = stroke[i], b = stroke[std::min(i + 1, stroke.size() - 1)];
        ink.stroke({at.x + unit * a.x, at.y - unit * a.y}, {at.x + unit * b.x, at.y - unit * b.y}, weight);
      }
    at.x += unit * (glyph.width + gap);
  }
}

}  // namespace mansard::picture::detail
