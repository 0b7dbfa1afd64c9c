#include "mansard/pipeline/detail/said.hpp"

#include <algorithm>
#include <iterator>

#include "mansard/base/text.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::pipeline::detail {

auto source_of(const SaidOf& said) -> roof::Source {
  if (said.parts.empty()) return said.whole.form.source;
  roof::Source out = said.with_outline ? said.whole.form.source : roof::Source::height;
  for (const auto& part : said.parts) out = std::max(out, part.form.source);
  return out;
}

auto cover_of(const model::Footprint& footprint) -> std::optional<Cover> {
  std::vector<geometry::Polygon> parts;
  for (const auto& part : footprint.parts) parts.insert(parts.end(), part.polygons.begin(), part.polygons.end());
  const auto outline = geometry::unite(footprint.polygons), covered = geometry::unite(parts);
  if (!outline || !covered) return std::nullopt;
  Cover out;
  double all = 0, shared = 0;
  for (const auto& polygon : *covered) all += geometry::area(polygon);
  for (const auto& polygon : *outline) {
    out.outline += geometry::area(polygon);
    for (const auto& other : *covered) {
      const auto both = geometry::intersect(polygon, other);
      if (!both) return std::nullopt;
      for (const auto& one : *both) shared += geometry::area(one);
    }
  }
  out.left = std::max(0.0, out.outline - shared);
  out.beyond = std::max(0.0, all - shared);
  return out;
}

auto in_words(const Cover& cover) -> std::string {
  constexpr double least = 1;  // m²; what is less is how it was drawn
  constexpr double share = 0.01;
  const auto much = [&](double area) { return area > least && area > share * cover.outline; };
  std::string words;
  if (much(cover.left))
    words = "leave " + base::to_text(cover.left, 0) + " m² (" + base::to_text(100 * cover.left / cover.outline, 0) +
            " %) of its outline without a model";
  if (much(cover.beyond))
    words += (words.empty() ? "" : ", and ") + ("reach " + base::to_text(cover.beyond, 0) + " m² beyond its outline");
  return words.empty() ? words : "its building:parts " + words;
}

auto said_of(const model::Footprint& footprint, const Options& options, bool by_attributes) -> SaidOf {
  const auto read = [&](const model::Attributes& attributes) {
    auto form = roof::form_of(attributes, options.roof);
    auto paint = roof::paint_of(attributes, options.roof);
    Said out{form.form, std::move(paint.paint), std::move(form.warnings)};
    std::ranges::move(paint.warnings, std::back_inserter(out.warnings));
    if (!by_attributes) out.form.base = 0;
    return out;
  };
  SaidOf out{read(footprint.attributes), {}, true};
  if (!by_attributes) return out;  // one profile for every edge: that of the outline
  for (const auto& part : footprint.parts) {
    auto one = read(roof::inherited(part.attributes, footprint.attributes, options.roof));
    for (auto& warning : one.warnings) warning.subject = part.id;
    out.parts.push_back(std::move(one));
  }
  if (out.parts.empty()) return out;
  const auto cover = options.roof.outline_cover > 0 ? cover_of(footprint) : std::nullopt;
  out.with_outline = cover && cover->outline - cover->left < options.roof.outline_cover * cover->outline;
  return out;
}

auto in_hex(const roof::Colour& colour) -> std::string {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out = "#";
  for (const auto c : colour) {
    out += digits[c / 16];
    out += digits[c % 16];
  }
  return out;
}

}  // namespace mansard::pipeline::detail
