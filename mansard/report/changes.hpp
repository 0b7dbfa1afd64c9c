// What has changed between two states of a city, for people and for other programs: a table, a layer, attributes, a
// picture and a summary.
#pragma once

#include <string>
#include <vector>

#include "mansard/compare/compare.hpp"
#include "mansard/formats/attributes.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::report {

/// What was compared, and what came of it. The states are in the frame.
struct Changes {
  const compare::State& old;
  const compare::State& now;
  compare::Comparison found;
  compare::Options options;
  model::Frame frame;
  std::string old_name, new_name;  ///< the files
  std::vector<model::InputFile> inputs;
  std::string version;  ///< of mansard
};

/// The attributes of a building that tell what has changed: ms_change and those that begin so.
[[nodiscard]] auto change_attributes(const Changes& changes, const compare::Change& change) -> model::Attributes;
/// Their meaning.
[[nodiscard]] auto change_attribute_list() -> std::vector<formats::Attribute>;

/// A row a building, with a header (RFC 4180): the building, then its attributes.
[[nodiscard]] auto changes_csv(const Changes& changes) -> std::string;
/// The layer `changes`: buildings of the new state, and those of the old one that are gone.
[[nodiscard]] auto changes_layers(const Changes& changes) -> std::vector<formats::Layer>;
[[nodiscard]] auto changes_json(const Changes& changes) -> std::string;
/// A map as SVG, coloured by kind, north up. Pointing at a building shows its evidence.
[[nodiscard]] auto changes_svg(const Changes& changes) -> std::string;
/// A few lines for a person.
[[nodiscard]] auto changes_summary(const Changes& changes) -> std::string;

}  // namespace mansard::report
