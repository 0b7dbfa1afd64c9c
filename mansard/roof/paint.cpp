// Colours and materials of a building's surfaces, and what a part takes from its outline.
#include <algorithm>
#include <array>

#include "mansard/base/text.hpp"
#include "mansard/roof/detail/tags.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof {
namespace {

using detail::Key;
namespace keys = detail::keys;

/// The first of several values ("brick;glass"), as each has one colour.
auto first_of(const std::string& text) -> std::string {
  std::string one = text.substr(0, text.find(';'));
  while (one.ends_with(' ')) one.pop_back();
  return one;
}

void read(const detail::Tags& tags, const Key& colour, const Key& material, std::optional<Colour>& into,
          std::string& made_of, std::vector<base::Diagnostic>& warnings) {
  if (const auto tag = tags.find(material)) {
    made_of = first_of(tag->text);
    into = detail::colour_of_material(made_of);  // another material has no colour, and is kept as it is
  }
  const auto tag = tags.find(colour);
  if (!tag) return;
  if (const auto known = detail::colour_of(first_of(tag->text))) {
    into = known;
    return;
  }
  warnings.push_back(base::warning("roof-value", tag->name + " = \"" + base::on_one_line(tag->text) +
                                                     "\" is not a colour such as #b03020 or brown; it is left out"));
}

}  // namespace

auto paint_of(const model::Attributes& attributes, const Options& options) -> ReadPaint {
  const detail::Tags tags(attributes, options);
  ReadPaint out;
  read(tags, keys::wall_colour(), keys::wall_material(), out.paint.wall, out.paint.wall_material, out.warnings);
  read(tags, keys::roof_colour(), keys::roof_material(), out.paint.roof, out.paint.roof_material, out.warnings);
  return out;
}

auto inherited(const model::Attributes& part, const model::Attributes& outline, const Options& options)
    -> model::Attributes {
  const detail::Tags own(part, options), of_outline(outline, options);
  model::Attributes out = part;
  const auto take = [&](const Key& key) {
    if (own.find(key)) return;
    if (const auto tag = of_outline.find(key)) {
      // Under the name that options ask for, before what the part has of that name without a value.
      const std::string wanted = key.attribute == nullptr ? std::string() : options.*key.attribute;
      std::erase_if(out, [&](const auto& one) { return one.first == tag->name; });
      out.insert(out.begin(), {wanted.empty() ? std::string(key.tag) : wanted, tag->text});
    }
  };
  if (!own.find(keys::wall_colour()) && !own.find(keys::wall_material())) {
    take(keys::wall_colour());
    take(keys::wall_material());
  }
  if (!own.find(keys::roof_colour()) && !own.find(keys::roof_material())) {
    take(keys::roof_colour());
    take(keys::roof_material());
  }
  if (own.find(keys::height()) || own.find(keys::levels()) || own.find(keys::roof_levels())) return out;
  for (const Key* key :
       {&keys::height(), &keys::levels(), &keys::min_height(), &keys::min_level(), &keys::shape(), &keys::roof_height(),
        &keys::roof_levels(), &keys::angle(), &keys::orientation(), &keys::direction()})
    take(*key);
  return out;
}

}  // namespace mansard::roof
