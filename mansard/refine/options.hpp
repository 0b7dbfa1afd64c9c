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

/// The first six are what a user may ask for. The groups are the search's own numbers, by the file of `detail/` that
/// uses them: advanced options, of which few are measured; `option_list` gives meaning, range and source of each.
struct Options {
  Effort effort = Effort::parts;
  double detail = 0.1;        ///< m; the smallest step on 4 m² that is of interest
  double significance = 1.0;  ///< how many times what noise explains by chance a number must explain
  double grid = 0.25;         ///< m between samples seen from above
  double least_area = 1.0;    ///< m²; smaller structures stay with the roof they are on
  double robust = 3.0;        ///< m; greater differences count linearly, not squared: trees, debris

  // No options: `decided_by` (law.hpp) sets them by the accuracy of the scan. These are those of a fair photogrammetric
  // mesh, with a noise of 0.1 m over 10 m².
  double face_price = 0.3;   ///< m² · m²; what an additional face must take off the sum of squared differences
  double part_price = 2.0;   ///< the same, of an additional part, beside its faces
  double value_price = 0.1;  ///< the same, of a height or pitch that differs from all others
  double same_cost = 1e-3;   ///< the same; costs nearer to each other are equal
  double margin = 0.4;       ///< m along the outline where samples count less

  /// What the mesh shows, and how much a sample counts (site, refit, and wherever a wall is near).
  struct Samples {
    double margin_weight = 0.2;                   ///< no option: decided_by
    static constexpr double max_cells = 150'000;  ///< bounds memory: a hall of 9,000 m² is still sampled at 0.25 m
    double level_band = 0.5;                      ///< m; no option: profile.cap_level
    double melt = 0.5;                            ///< m; no option: decided_by
    double blur = 0.25;                           ///< m; no option: decided_by
    double point_area = 0;                        ///< m² a point; 0: a surface is sampled. No option: decided_by
    double noise = 0;                             ///< m; of a point. No option: decided_by
    double stray = 1;                             ///< m; points farther off count no more. No option: decided_by
  } samples;

  /// Robust lines through heights (lines).
  struct Lines {
    double robust = 0.25;  ///< m; no option: decided_by
    /// Number of times that the samples of a line are weighted again. Reweighing converges well before; not measured.
    std::int64_t rounds = 8;
    /// A line is fitted to at least this many samples; each side of a split has as many. Chosen by hand; not measured.
    std::int64_t min_samples = 12;
    double min_spread = 0.25;  ///< m; no option: decided_by
  } lines;

  /// The forms of roof that every part is tried with (forms).
  struct Forms {
    /// Of the samples over a part, every so many are used for a form's pitch that about this many remain. More would
    /// not move a line; not measured.
    std::int64_t samples = 800;
    double min_height = 0.5;                      ///< m
    double cap_percentile = 0.99;                 ///< no option: profile.cap_ridge
    double cap_clearance = 0.5;                   ///< m; no option: profile.cap_clear
    static constexpr double cap_distinct = 0.05;  ///< m; nearer ones are one candidate, tried once
    /// A form with a smaller slope (rise per run) is not proposed. Chosen by hand; not measured.
    double min_slope = 0.05;
    double max_slope = 5;
    /// Number of directions of a part along which gables and single pitches are tried. Chosen by hand; not measured.
    std::int64_t max_axes = 3;
    /// Two directions whose cosine is greater than this are one direction. 0.9 is an angle of about 26°; chosen by
    /// hand, not measured.
    double axis_cosine = 0.9;
    /// A side carries the roof of a direction where the cosine between the two is greater than this. 0.8 is an angle of
    /// about 37°; chosen by hand, not measured.
    double across_cosine = 0.8;
    /// A side may be a gable end where the sine of the turn at both of its corners is greater than this. 0.5 is an
    /// angle of 30°; chosen by hand, not measured.
    double gable_turn = 0.5;
    /// A side may be a gable end where its length is less than this multiple of its shorter neighbour's. Chosen by
    /// hand; not measured.
    double gable_length = 1.2;
  } forms;

  /// A steep foot below a flatter roof (forms).
  struct Mansard {
    double min_depth = 0.7;  ///< m; no option: decided_by
    double max_depth = 3;    ///< m
    double min_rise = 1.5;   ///< m
    /// Minimum slope (rise per run) of the steep part of a mansard roof. Chosen by hand; not measured.
    double min_slope = 1.2;
    /// The slope of the upper part of a mansard roof is at most this share of the steep part's. Chosen by hand; not
    /// measured.
    double upper_share = 0.5;
  } mansard;

  /// Two pitches where one was (bends).
  struct Bends {
    double min_depth = 0.7;  ///< m; no option: decided_by
  } bends;

  /// A level strip along a side with something higher behind it (forms).
  struct Setback {
    double max_depth = 4;   ///< m
    double behind = 3;      ///< m
    double min_rise = 0.8;  ///< m
    /// A step is proposed where a level and a line leave less than this share of the squares that one line leaves.
    /// Docs/decisions/0017-setbacks-by-measured-error.md.
    double max_rest = 0.8;
  } setback;

  /// Planes moved to the samples on their own faces (refit).
  struct Refit {
    /// A plane with fewer samples on its faces stays as it is. Chosen by hand; not measured.
    std::int64_t min_samples = 4;
    /// A cap with fewer samples on its faces stays as it is. Chosen by hand; not measured.
    std::int64_t min_cap_samples = 8;
  } refit;

  /// The best roof over a fixed outline (roof_search).
  struct Search {
    /// A later cap replaces an earlier one where its error is less than this share of the earlier one's.
    /// Docs/decisions/0008-cap-by-measured-error.md.
    double cap_gain = 0.95;
    /// Maximum number of times that a roof's planes are refitted in a row. Chosen by hand; not measured.
    std::int64_t settle_rounds = 3;
    /// Number of forms that a thorough search follows. Chosen by hand; not measured.
    std::int64_t starts = 4;
    /// Number of forms that a quick search follows. Chosen by hand; not measured.
    std::int64_t quick_starts = 2;
    /// The bound of a building's search: 100 µs a sample of its parts, in units of account.hpp, where a corner counts
    /// as 100 samples. No option. Of 263 buildings the dearest, b9, takes 61 µs, half of them under 1.
    /// Docs/decisions/0132-bounded-work.md.
    std::int64_t most_work = 10000;
    /// Roofs that one search asks for, one after the other. No option: ordinary ones ask for at most 500, but a ring of
    /// 250 corners and as many profiles for 5,000. Docs/decisions/0132-bounded-work.md.
    std::int64_t most_roofs = 1000;
    static constexpr double hopeless = 2;  ///< a limit on the search: going on never halved a roof's cost
    /// Number of times that all sides of a part are tried in turn. Chosen by hand; not measured.
    std::int64_t rounds = 2;
    /// All sides are tried again where the last round reduced the cost to at most this share. Chosen by hand; not
    /// measured.
    double round_gain = 0.98;
    /// Of a part with more sides, this many, the longest, are tried. Chosen by hand; not measured.
    std::int64_t max_sides = 24;
    /// Two sides are opposite where the negative cosine of their directions is greater than this. 0.95 is an angle of
    /// about 18°; chosen by hand, not measured.
    double opposite_cosine = 0.95;
  } search;

  /// Planes as they were before the scan melted them (sharpen).
  struct Sharpen {
    /// Maximum number of times that planes are refitted to the middle of their faces. Chosen by hand; not measured.
    std::int64_t rounds = 2;
    double level_slope = 0.6;
    /// Pitches explain little where they leave at least this share of the squared differences of a flat roof, explain
    /// at most this share of those away from the outline, and save less than a part costs.
    /// Docs/decisions/0102-pitches-that-explain-little.md.
    double level_gain = 0.8;
  } sharpen;

  /// Eaves, ridges and pitches made equal (alike).
  struct Alike {
    double bias = 0;  ///< m; what is wrong with the height of a plane however large it is. No option: decided_by
  } alike;

  /// Plans cut in two and joined (pieces).
  struct Pieces {
    /// An edge takes a profile where at least this share of its length runs along edges with it. Chosen by hand; not
    /// measured.
    double profile_share = 0.5;
    /// No piece is cut out of which less than this share is known: crowns hide the rest, or the scan has holes. Chosen
    /// by hand; not measured.
    double seen_share = 0.7;
    double min_width = 0.6;  ///< m
    double slit = 0.02;      ///< m
    double straight = 1e-3;  ///< m
  } pieces;

  /// Faces that the scan cannot have shown (bare).
  struct Bare {
    std::int64_t cells = 3;
    double steep = 65 * std::numbers::pi / 180;  ///< rad
    double noise = 0.15;                         ///< m; no option: decided_by
    double area = 1;                             ///< m²
  } bare;

  /// Parts that are taller than they are wide (tall).
  struct Tall {
    double ratio = 3;
    /// Walls are seen where the scan is near to this share of the places that are looked at on them.
    /// Docs/decisions/0086-tall-parts-and-crowns.md.
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
    static constexpr std::int64_t shared_faces = 8;  ///< a bound, so that joins which cannot pay are not tried
    double recut_reach = 1.5;                        ///< m
    static constexpr std::int64_t max_pieces = 64;   ///< a limit on the search
  } joins;

  /// Cuts where the edges of wings go on inside (wings, work).
  struct Wings {
    /// A corner is reflex where the sine of its turn outwards is greater than this. 0.35 is an angle of 20°; chosen by
    /// hand, not measured.
    double reflex_sine = 0.35;
    std::int64_t max_cuts = 6;
  } wings;

  /// What may become a part of its own (propose).
  struct Cuts {
    double min_step = 0.5;                        ///< m; no option: decided_by
    double min_width = 0.8;                       ///< m; no option: decided_by
    double min_area = 4;                          ///< m²; no option: decided_by
    static constexpr std::int64_t max_count = 6;  ///< a limit on the search
    /// A line across a part is proposed where it explains at least this share of the part's error. Chosen by hand; not
    /// measured.
    double line_gain = 0.15;
    double line_min_width = 1.25;  ///< m; no option: decided_by
    /// Two cuts are one where at most this share of their cells is on different sides. Chosen by hand; not measured.
    double same_share = 0.25;
    /// An outline is ranked lower than a line by this share of its gain. Chosen by hand; not measured.
    double outline_price = 0.04;
    /// Cuts are compared with at most about this many samples; of more, every second or third is used. Chosen by hand;
    /// not measured.
    double max_cells = 8000;
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
    /// Dormers are on slopes no steeper than this. Chosen by hand; not measured.
    double max_slope = 2;
    /// Share of the squared difference from the slope that a dormer may leave; a tree or a chimney leaves more.
    /// Docs/decisions/0087-dormers-by-default.md.
    double max_rest = 0.25;
    /// A dormer is gabled where that leaves less than this share of the error of a level one. Chosen by hand; not
    /// measured.
    double gable_gain = 0.8;
  } dormers;

  /// The direction of a part, and rasters along it (propose_raster).
  struct Directions {
    double same = 5 * std::numbers::pi / 180;  ///< rad
    /// A place has a height where the cells around it that were sampled have at least this weight of bilinear
    /// interpolation. Chosen by hand; not measured.
    double min_weight = 0.25;
  } directions;

  /// Connected regions above or below the model (propose_regions).
  struct Regions {
    static constexpr std::int64_t gap_cells = 3;  ///< of the grid
    /// A region has at least this share of cuts.min_area; its outline may have more. Chosen by hand; not measured.
    double min_area_share = 0.75;
    /// A region is used where at least this share of its cells was sampled. Chosen by hand; not measured.
    double seen_share = 0.6;
    /// What a region surrounds is tried in its place where the region fills at most this share of its box. Chosen by
    /// hand; not measured.
    double hollow_share = 0.75;
  } regions;

  /// Rectangles around such regions, and their walls (propose_outline).
  struct Outlines {
    /// Rectangles are looked for on a grid of at most this many cells a side. Chosen by hand; not measured.
    std::int64_t cells = 48;
    /// Price of a cell outside the part, where a cell of the region has a worth of 1. Chosen by hand; not measured.
    double outside_price = 0.05;
    /// A rectangle has at least this share of cuts.min_area. Chosen by hand; not measured.
    double min_area_share = 0.4;
    /// A rectangle is at least this share of refine.cuts_min_width wide. Chosen by hand; not measured.
    double min_width_share = 0.8;
    /// A wall goes out to the part's edge where at least this share of its rows ends near it. Chosen by hand; not
    /// measured.
    double push_share = 0.9;
    double near_edge = 0.6;   ///< m
    double near_line = 0.25;  ///< m
    /// A wall and an edge are parallel where the offset per length is at most this. 0.09 is 5°; chosen by hand, not
    /// measured.
    double max_slant = 0.09;
    double min_overlap = 0.5;  ///< m
    double max_gap = 1;        ///< m
  } outlines;

  /// Straight lines across a part (propose_split).
  struct Splits {
    double apart = 1.5;                              ///< m
    static constexpr std::int64_t max_count = 3;     ///< a limit on the search
    static constexpr std::int64_t rows_per_bin = 2;  ///< of the grid
    /// A line is a step or a valley where more than this share of its rows is. Chosen by hand; not measured.
    double row_share = 0.6;
  } splits;

  /// Simple surfaces that cuts are judged by (propose_surface).
  struct Surfaces {
    static constexpr double bin = 0.5;  ///< m; of the grid
    double max_slope = 1.5;
    /// A cut is evaluated by what two surfaces explain beyond one where one explains at least all but this share of the
    /// model's error. Chosen by hand; not measured.
    double model_share = 0.5;
  } surfaces;
};

/// The six, then the groups as advanced options: `Options::wings.min_length` is `wings_min_length`.
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::refine
