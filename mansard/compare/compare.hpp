// What has changed between two states of a city: which buildings are new, gone, raised, lowered, extended, reduced or
// re-roofed, by how much, and how sure that is.
//
// A place has changed where every old surface differs from every new one in the same direction: the models of both
// states and, where they are at hand, the scans that these were made from. A fault of a model alone is then no change,
// nor is a crown or a crane that only a scan has.
//
// References: Y. Benjamini and Y. Hochberg, Controlling the false discovery rate (1995); B. Efron, Large-scale
// simultaneous hypothesis testing: the choice of a null hypothesis (2004), for errors that are measured on what is
// compared; J. Serra, Image analysis and mathematical morphology (1982), for the opening.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/accuracy.hpp"

namespace mansard::compare {

struct Options {
  double smallest = 0.5;      ///< m; lower changes are of no interest, nor those narrower than twice that
  double false_share = 0.02;  ///< expected share of false ones among the buildings that are reported
  std::optional<double> old_error, new_error;  ///< m; root mean square error of models that no attribute tells
  bool keep_offset = false;                    ///< a difference that all buildings have counts as a change
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// m; of models of which nothing says how accurate they are, where too few buildings are in both states to measure it:
/// AdV, Produktstandard für 3D-Gebäudemodelle (LoD2: heights within 1 m).
inline constexpr double assumed_error = 1.0;

/// A building of one state.
struct Building {
  std::string id;
  std::vector<geometry::Polygon> outline;  ///< on the ground, m
  double ground = 0;                       ///< z, m
  std::optional<double> right;             ///< probability that the model is right
  std::optional<double> error;             ///< m; root mean square vertical error of the model
};

/// A city at one time. Both states have one frame.
struct State {
  std::vector<Building> buildings;
  geometry::Mesh models;     ///< of all buildings
  geometry::Mesh scan;       ///< that they were made from; without triangles: not at hand
  model::Accuracy accuracy;  ///< of the scan; its offset is what to add to outlines to come to the scan
};

enum class Kind : std::uint8_t {
  unchanged,
  built,     ///< a building where none was ("new")
  gone,      ///< none where one was
  raised,    ///< its roof, or a part of it, is higher by a constant
  lowered,   ///< the same, lower
  extended,  ///< on ground that was not built on
  reduced,   ///< a part is gone
  reroofed,  ///< the difference of heights is not constant
  unseen,    ///< nothing to compare: no model in one of the states
};
inline constexpr std::size_t kinds = 9;
/// "unchanged", "new", "gone", "raised", "lowered", "extended", "reduced", "re-roofed", "not compared".
[[nodiscard]] auto to_string(Kind kind) -> std::string_view;

/// What of a building has changed in one way.
struct Part {
  Kind kind = Kind::unchanged;
  double area = 0;                    ///< m² of ground
  double height = 0;                  ///< m; median of new − old over it, offset taken off
  double error = 0;                   ///< m; standard error of that
  double volume = 0;                  ///< m³; gained, or lost where negative
  double mean = 0;                    ///< m; mean difference of the surfaces that differ least
  double old_seen = 0, new_seen = 0;  ///< share of it that the scan of the state covers
  double sigmas = 0;                  ///< mean difference over its standard error
  double chance = 1;                  ///< probability that nothing but errors of both states gives so much
};

/// One building of the new state, with what was on its ground, or one of the old state that is gone.
struct Change {
  std::vector<std::uint32_t> now, old;  ///< numbers in their states; `now` has one, or none; old by shared ground
  Kind kind = Kind::unchanged;          ///< of the part with the largest volume
  std::vector<Part> parts;              ///< significant ones by volume, the largest first
  double height = 0, height_error = 0;  ///< m; median of new − old over the ground of both, and its standard error
  double rms = 0;                       ///< m; root mean square of new − old of the models over the same ground
  double chance = 1;                    ///< that of the building: the least, times the number of ways that were tested
  std::size_t cells = 0;                ///< that were compared
  double area = 0, common = 0;          ///< m²; of these, and of those that are built on in both states
  double differing = 0;                 ///< m² that differ, whether that is significant or not
  double old_seen = 0, new_seen = 0;    ///< share of these that the scan of the state covers
  bool doubtful = false;                ///< one of its models is probably wrong
  std::vector<std::string> why;         ///< evidence and doubts, in words
};

/// What all buildings have in common: new − old.
struct Offset {
  double height = 0, height_error = 0;      ///< m; median over buildings, and its standard error
  geometry::Point2 plan, plan_error;        ///< m; of outlines
  std::size_t buildings = 0, outlines = 0;  ///< that it was measured from
  bool removed = false;
};

struct Comparison {
  std::vector<Change> changes;  ///< by the buildings of the new state, then those that are gone by the old one
  Offset offset;
  std::optional<double> model_error;  ///< m; root mean square difference of the models of an unchanged building
  double scale = 1;                   ///< what errors were multiplied by, as measured on unchanged buildings
  double critical = 0;                ///< chances up to this are significant
  double step = 0.25;                 ///< m; of the finest grid
  [[nodiscard]] auto count(Kind kind) const -> std::size_t;
};

/// Guarantees: 1 equal states have no change · 2 with the states exchanged, new and gone, raised and lowered, extended
/// and reduced change places · 3 ids, the order of buildings and the number of threads do not matter · 4 a shift of one
/// state that all buildings share is no change, from five buildings on.
/// Cost: O(cells · log n); about 4,000 cells a building, at most.
[[nodiscard]] auto changes(const State& old, const State& now, const Options& options, const base::Run& run = {})
    -> Comparison;

}  // namespace mansard::compare
