// What refine minimises, and every number that decides where its search goes.
#pragma once

#include <cstdint>
#include <numbers>

#include "mansard/base/options.hpp"

namespace mansard::refine {

enum class Effort : std::uint8_t {
  caps,    ///< only the height at which the roof ends
  planes,  ///< the profiles too: which edges carry roof, and where its planes are
  parts,   ///< and the plan: parts under one roof are joined, structures of another height become parts of their own
};

/// The first six are what a user may ask for. The groups are the search's own numbers, by the file of `detail/` that uses them:
/// advanced options, of which few are measured; `option_list` gives meaning, range and source of each.
struct Options {
  Effort effort = Effort::parts;
  double detail = 0.1;         ///< m; the smallest step on `least_area` that is of interest
  double significance = 1.0;   ///< how many times what noise explains by chance a number must explain
  double grid = 0.25;          ///< m between samples seen from above
  double least_area = 4.0;     ///< m²; smaller structures stay with the roof they are on
  double robust = 3.0;           ///< m; greater differences count linearly, not squared: trees, debris

  // No options: `decided_by` (law.hpp) sets them by the accuracy of the scan. These are those of a fair photogrammetric
  // mesh, with a noise of 0.1 m over 10 m².
  double face_price = 0.3;   ///< m² · m²; what an additional face must take off the sum of squared differences
  double part_price = 2.0;   ///< the same, of an additional part, beside its faces
  double value_price = 0.1;  ///< the same, of a height or pitch that differs from all others
  double same_cost = 1e-3;   ///< the same; costs nearer to each other are equal
  double margin = 0.4;       ///< m along the outline where samples count less

  /// What the mesh shows, and how much a sample counts (site, refit, and wherever a wall is near).
  struct Samples {
    double margin_weight = 0.2;  ///< no option: decided_by
    static constexpr double max_cells = 150'000;  ///< bounds memory: a hall of 9,000 m² is still sampled at 0.25 m
    double level_band = 0.5;                      ///< m; no option: profile.cap_level
    double melt = 0.5;   ///< m; no option: decided_by
    double blur = 0.25;  ///< m; no option: decided_by
  } samples;

  /// Robust lines through heights (lines).
  struct Lines {
    double robust = 0.25;  ///< m; no option: decided_by
    std::int64_t rounds = 8;
    std::int64_t min_samples = 12;
    double min_spread = 0.25;  ///< m
  } lines;

  /// The forms of roof that every part is tried with (forms).
  struct Forms {
    std::int64_t samples = 800;
    double min_height = 0.5;                      ///< m
    double cap_percentile = 0.99;                 ///< no option: profile.cap_ridge
    double cap_clearance = 0.5;                   ///< m; no option: profile.cap_clear
    static constexpr double cap_distinct = 0.05;  ///< m; nearer ones are one candidate, tried once
    double min_slope = 0.05;
    double max_slope = 5;
    std::int64_t max_axes = 3;
    double axis_cosine = 0.9;
    double across_cosine = 0.8;
    double gable_turn = 0.5;
    double gable_length = 1.2;
  } forms;

  /// A steep foot below a flatter roof (forms).
  struct Mansard {
    double min_depth = 0.7;  ///< m
    double max_depth = 3;    ///< m
    double min_rise = 1.5;   ///< m
    double min_slope = 1.2;
    double upper_share = 0.5;
  } mansard;

  /// A level strip along a side with something higher behind it (forms).
  struct Setback {
    double max_depth = 4;   ///< m
    double behind = 3;      ///< m
    double min_rise = 0.8;  ///< m
    double max_rest = 0.8;
  } setback;

  /// Planes moved to the samples on their own faces (refit).
  struct Refit {
    double min_slope = 0.03;
    std::int64_t min_samples = 4;
    std::int64_t min_cap_samples = 8;
    double max_knot_move = 1.5;  ///< m
  } refit;

  /// The best roof over a fixed outline (roof_search).
  struct Search {
    double cap_gain = 0.95;
    std::int64_t settle_rounds = 3;
    std::int64_t starts = 4;
    std::int64_t quick_starts = 2;
    static constexpr double hopeless = 2;  ///< a limit on the search: going on never halved a roof's cost
    std::int64_t rounds = 2;
    double round_gain = 0.98;
    std::int64_t max_sides = 24;
    double opposite_cosine = 0.95;
  } search;

  /// Planes as they were before the scan melted them (sharpen).
  struct Sharpen {
    std::int64_t rounds = 2;
    double level_slope = 0.6;
    double level_gain = 0.8;
  } sharpen;

  /// Eaves, ridges and pitches made equal (alike).
  struct Alike {
    double most_ground = 10;  ///< m²
  } alike;

  /// Plans cut in two and joined (pieces).
  struct Pieces {
    double profile_share = 0.5;
    double seen_share = 0.7;
    double min_width = 0.6;  ///< m
    double slit = 0.02;      ///< m
    double straight = 1e-3;  ///< m
  } pieces;

  /// Faces that the scan cannot have shown (bare).
  struct Bare {
    std::int64_t cells = 3;
    double steep = 65 * std::numbers::pi / 180;  ///< rad
    double noise = 0.15;                         ///< m
    double area = 1;                             ///< m²
  } bare;

  /// Parts that are taller than they are wide (tall).
  struct Tall {
    double ratio = 3;
    double walls = 0.5;
    static constexpr double spacing = 0.5;  ///< m; of the grid of places
    double clear = 0.5;                     ///< m
    double reach = 0.4;                     ///< m
    double inside = 0.4;                    ///< m
    double beside = 0.75;                   ///< m
  } tall;

  /// Which parts are joined, cut and cut again (work, owner).
  struct Joins {
    /// m; straightened neighbours differ by up to 0.01 m: five times that
    static constexpr double touching = 0.05;
    double quick_excess = 1.15;
    static constexpr std::int64_t shared_faces = 8;  ///< a bound, so that joins which cannot pay are not tried
    double recut_reach = 1.5;                        ///< m
    static constexpr std::int64_t max_pieces = 64;   ///< a limit on the search
  } joins;

  /// Cuts where the edges of wings go on inside (wings, work).
  struct Wings {
    double reflex_sine = 0.35;
    std::int64_t max_cuts = 6;
  } wings;

  /// What may become a part of its own (propose).
  struct Cuts {
    double min_step = 0.5;                        ///< m
    double min_width = 0.8;                       ///< m
    static constexpr std::int64_t max_count = 6;  ///< a limit on the search
    double crisp_rms = 0.15;                      ///< m
    double smooth_rms = 0.35;                     ///< m
    double fullness = 0.73;
    std::int64_t fullness_part = 20;
    double hipped_min_area = 16;  ///< m²
    double fair_area = 30;        ///< m²
    double fair_rms = 0.45;       ///< m
    double large_area = 80;       ///< m²
    double large_gain = 0.8;
    double line_gain = 0.15;
    double line_min_width = 1.25;  ///< m
    double same_share = 0.25;
    double shape_price = 0.04;
    double askew_price = 0.25;
    double new_direction = 0.14;                       ///< rad
    static constexpr std::int64_t max_directions = 4;  ///< a limit on the search
    double max_cells = 8000;
    double sliver_area = 1;                   ///< m²
    double sliver_width = 0.5;                ///< m
    static constexpr double rise_reach = 2;   ///< m; four times samples.melt; only told, decides nothing
    static constexpr double min_rise = 0.25;  ///< m; half of min_step; only told, decides nothing
  } cuts;

  /// Dormers on slopes, parts of their own (dormers).
  struct Dormers {
    bool wanted = true;
    double price = 0.15;     ///< m² · m²; 0: no dormers; else no option: decided_by
    double min_width = 1.1;  ///< m
    double max_width = 5;    ///< m
    double min_rise = 0.6;   ///< m
    double max_rise = 3;     ///< m
    double min_slope = 0.25;
    double max_slope = 2;
    double max_rest = 0.25;
    double gable_gain = 0.8;
  } dormers;

  /// The directions of a part, and rasters along them (propose_raster).
  struct Directions {
    double same = 5 * std::numbers::pi / 180;    ///< rad
    double other = 12 * std::numbers::pi / 180;  ///< rad
    double second_share = 0.25;
    double min_weight = 0.25;
  } directions;

  /// Connected regions above or below the model (propose_regions).
  struct Regions {
    static constexpr std::int64_t gap_cells = 3;  ///< of the grid
    double bin = 0.25;                            ///< m
    static constexpr double max_residual = 40;    ///< m; the histogram ends there
    double peak_share = 0.5;
    double valley = 0.5;
    static constexpr std::int64_t max_levels = 6;  ///< a limit on the search
    double level_clearance = 1.5;
    double min_area_share = 0.75;
    double seen_share = 0.6;
    double hollow_share = 0.75;
    static constexpr std::int64_t rim_cells = 2;  ///< of the grid
    double agreement = 0.6;
  } regions;

  /// Rectangles around such regions, and their walls (propose_outline).
  struct Outlines {
    std::int64_t cells = 48;
    double outside_price = 0.05;
    std::int64_t max_rectangles = 3;
    double min_area_share = 0.4;
    double min_addition = 0.08;
    double min_width_share = 0.8;
    double min_contrast = 0.3;  ///< m
    double max_move = 1;        ///< m
    double row_share = 0.3;
    std::int64_t step_rounds = 3;
    std::int64_t settle_rounds = 2;
    double push_share = 0.9;
    double near_edge = 0.6;   ///< m
    double near_line = 0.25;  ///< m
    double max_slant = 0.09;
    double min_overlap = 0.5;  ///< m
    double max_gap = 1;        ///< m
  } outlines;

  /// Straight lines across a part (propose_split).
  struct Splits {
    double apart = 1.5;                              ///< m
    static constexpr std::int64_t max_count = 3;     ///< a limit on the search
    static constexpr std::int64_t rows_per_bin = 2;  ///< of the grid
    double row_share = 0.6;
    double step_share = 0.7;
    double min_valley = 0.15;  ///< m
  } splits;

  /// Simple surfaces that cuts are judged by (propose_surface).
  struct Surfaces {
    static constexpr double bin = 0.5;  ///< m; of the grid
    double ridge_min_area = 30;         ///< m²
    double max_slope = 1.5;
    double model_share = 0.5;
  } surfaces;
};

/// The six, then the groups as advanced options: `Options::wings.min_length` is `wings_min_length`.
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::refine
