#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/text.hpp"

namespace mansard::accuracy {
namespace {

using base::to_text;

/// cm: vertical accuracy classes by their limit of the RMSE in height (ASPRS, Positional Accuracy Standards for Digital
/// Geospatial Data, edition 1, 2014, table B.7).
constexpr std::array classes{1.0, 2.5, 5.0, 10.0, 15.0, 20.0, 33.3, 66.7, 100.0};

auto noise_in_words(double noise) -> std::string {
  if (noise == 0) return "none (RMSE in height under 1 mm)";
  const auto fits = std::ranges::find_if(classes, [&](double c) { return 100 * noise <= c; });
  std::string text = to_text(noise, 3) + " m (RMSE in height on level surfaces";
  if (fits != classes.end())
    text += "; within the ASPRS vertical accuracy class of " + to_text(*fits, *fits == std::floor(*fits) ? 0 : 1) +
            " cm, apart from an offset in height";
  return text + ")";
}

auto way(double metres, const char* positive, const char* negative) -> std::string {
  return to_text(std::abs(metres), 2) + " m " + (metres < 0 ? negative : positive);
}

}  // namespace

auto in_words(const model::Accuracy& a) -> std::vector<std::pair<std::string, std::string>> {
  std::vector<std::pair<std::string, std::string>> out;
  if (a.windows > 0) {
    out.emplace_back("noise", noise_in_words(a.noise));
    if (a.noise > 0) out.emplace_back("correlated area", to_text(a.correlated_area, 2) + " m²");
    out.emplace_back("nominal point spacing", to_text(a.spacing, 2) + " m");
  }
  if (a.transects > 0) {
    out.emplace_back("blur of edges", a.blur > 0 ? to_text(a.blur, 2) + " m" : std::string("none"));
    out.emplace_back("noise of edges", to_text(a.edge_noise, 2) + " m along straight walls");
    out.emplace_back("walls seen", to_text(100 * a.walls, 0) + " %");
  }
  if (a.edges > 0)
    out.emplace_back("offset from footprints",
                     way(a.offset.x, "east", "west") + ", " + way(a.offset.y, "north", "south") + " (± " +
                         to_text(a.offset_error, 3) + " m); ± " + to_text(a.offset_spread, 2) + " m from wall to wall");
  return out;
}

auto in_a_sentence(const model::Accuracy& a) -> std::string {
  std::string out;
  for (const auto& [name, value] : in_words(a)) out += (out.empty() ? "" : "; ") + name + " " + value;
  return out.empty() ? "nothing could be measured" : out;
}

}  // namespace mansard::accuracy
