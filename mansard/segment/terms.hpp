// The terms of the objective, defined once: program, check of the objective, layers, run.json, sentences and tables go
// through this list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mansard/fracture/fracture.hpp"
#include "mansard/segment/options.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::segment {

enum class Term : std::uint8_t { sweep_unused, unsupported, height, thin, gis_unused };
inline constexpr std::size_t term_count = 5;

/// Whether an edge between two faces pays the term when it is cut (a wall) or when it is not.
enum class Paid : std::uint8_t { uncut, cut };

struct TermInfo {
  Term term;
  Paid paid;
  std::string_view name;     ///< in run.json, and in results.csv of `explore`
  std::string_view symbol;   ///< the paper's, in tables
  std::string_view words;    ///< in the command line's summary
  std::string_view caption;  ///< under pictures
  std::string_view cost;     ///< field of the layer `edges`: what an edge costs
  std::string_view amount;   ///< field of the layer `edges`: what it pays for, metres; empty for none
  /// The cost of a metre of edge that pays, for the height term of a metre by a metre of difference. None for `thin`:
  /// φ for each conflict.
  double Options::*weight;
  /// The share of a half-edge's length that pays; null where all of it does, by an amount measured on the whole edge.
  double (*share)(const fracture::HalfEdge&, const Options&);
  /// What is paid for, after "480 for"; by the amount, metres.
  std::string (*reason)(double amount);
};

/// All terms, in the order of Term.
[[nodiscard]] auto terms() -> std::span<const TermInfo, term_count>;

/// A number for each term.
struct Terms {
  std::array<double, term_count> values{};

  [[nodiscard]] auto operator[](Term term) -> double& { return values[static_cast<std::size_t>(term)]; }
  [[nodiscard]] auto operator[](Term term) const -> double { return values[static_cast<std::size_t>(term)]; }
  auto operator+=(const Terms& more) -> Terms& {
    for (std::size_t i = 0; i < term_count; ++i) values[i] += more.values[i];
    return *this;
  }
  [[nodiscard]] auto sum() const -> double {
    double all = 0;
    for (const double value : values) all += value;
    return all;
  }
  /// Of the terms that are paid then.
  [[nodiscard]] auto sum(Paid paid) const -> double;
};

}  // namespace mansard::segment
