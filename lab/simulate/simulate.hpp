// Known truth: whole blocks with planted buildings, and a mesh as a scan would show them.
// References: D. Perry, A. Gibbs, S. Gibson on surface nets (SIGGRAPH 1998 "Constrained Elastic Surface Nets"), for the
// surface of the scan; all else is described in docs/simulate.md.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/simulate/faults.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/label/label.hpp"
#include "mansard/model/city.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::simulate {

enum class Kind : std::uint8_t { terrace, perimeter, courtyard, towers, detached };
/// By the names of the enumeration.
[[nodiscard]] auto to_string(Kind kind) -> std::string_view;
[[nodiscard]] auto kind_of(std::string_view name) -> std::optional<Kind>;

/// What stands in a block. Lengths in metres.
struct BlockOptions {
  double size = 70;             ///< about the length of the block's street front
  std::optional<double> turn;   ///< rad; of the street against the x axis; none: drawn
  double slope = 0.02;          ///< metres that the street falls per metre
  double equal_heights = 0.35;  ///< share of neighbours with eaves at one height
  double annexes = 0.6;         ///< share of houses with something lower at the back
  double alike = 0;             ///< share of rows in which all houses are alike
  double dormers = 0;           ///< share of the slopes of gabled houses with dormers
  double plant_rooms = 0;       ///< share of flat roofs with a plant room
  double bays = 0;              ///< share of houses with a bay window
  double extensions = 0;        ///< share of houses without annex that have a rear extension of 0.8 m and more
  double overhang = 0;          ///< how far eaves overhang
};

/// How a surveyor draws the outlines. Metres.
struct SurveyOptions {
  double displacement = 0.2;          ///< all outlines moved by this
  double jitter = 0.05;               ///< every corner moved by up to this; corners in one place move together
  double generalise = 0.1;            ///< corners less than this off the line of their neighbours are left out
  double eaves = 0;                   ///< outlines drawn so much larger, but for party walls
  double merged = 0.1;                ///< share of party walls across which two houses are one feature
  std::optional<double> direction{};  ///< rad; of the displacement, from x; none: drawn
  bool heights = false;               ///< features have the attribute `height`, as a register would, to 0.1 m
};

/// How the scan sees the block. Lengths in metres.
struct ScanOptions {
  double resolution = 0.3;       ///< edge length of the mesh
  double melt = 0.25;            ///< standard deviation of the smoothing that melts corners and edges
  double noise = 0.04;           ///< root mean square along the normal
  double noise_length = 1.5;     ///< wavelength of that noise; 0: independent from vertex to vertex
  double noise_hidden = 1;       ///< how much stronger noise and bulge are where no camera sees
  double bulge = 0.04;           ///< root mean square of a longer wave of walls
  double bulge_length = 6;       ///< its wavelength
  double holes = 0.04;           ///< share of the walls' area lost where few cameras see
  double camera_tilt = 0.8;      ///< rad; of the cameras from straight down
  double missing_walls = 0.05;   ///< probability that a wall was not matched
  double missing_share = 0.5;    ///< how much of its height such a wall lacks, from below
  double trees = 8;              ///< per 1000 m² of open ground
  double cars = 6;               ///< per 1000 m² of open ground
  double chimneys = 0.5;         ///< probability per building
  double crowns = 0;             ///< probability per building of a tree whose crown is over its roof
  double roof_trees = 0;         ///< probability per building of a tree within its outline
  double ground_waves = 0.06;    ///< root mean square of the ground's bumps
  double ground_length = 12;     ///< their wavelength
  double seam = 0.03;            ///< largest step, in each direction, between the tiles of the mesh
  double tile = 60;              ///< side of a tile
  double margin = 12;            ///< ground around the buildings
  bool height_field = false;     ///< 2.5-D: one height per place; melt does not apply
  bool exact = false;            ///< the faces themselves, where keeps_faces() holds
  double points_noise = 0;       ///< standard deviation of the height of each point of airborne_points()
  double points_noise_plan = 0;  ///< and of its x and its y
  double faults = 0;             ///< share of buildings with a fault of the survey each: faults.hpp
};
/// Whether a scan consists of the faces of the truth: `exact` is set, and nothing is asked for that needs samples
/// (melt, noise, bulge, holes, missing walls, seams, trees, cars, chimneys, crowns, faults, a height field). Otherwise
/// the scan is sampled at `resolution`.
[[nodiscard]] auto keeps_faces(const ScanOptions& options) -> bool;

struct Options {
  std::int64_t seed = 1;
  BlockOptions block;
  SurveyOptions survey;
  ScanOptions scan;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// "simulate.name" → value, over the defaults: `clean`, `nadir-drone`, `oblique-aerial`, `lidar-2.5d`.
struct Preset {
  std::string name, meaning;
  std::vector<std::pair<std::string, std::string>> values;
};
[[nodiscard]] auto presets() -> const std::vector<Preset>&;

/// A stretch along which two buildings stand wall to wall.
struct PartyWall {
  geometry::Segment2 line;            ///< in plan, the first building on its left
  std::size_t first = 0, second = 0;  ///< indices into City::buildings
  /// z, metres: how high the walls of each stand there; none where there is no wall.
  std::optional<double> first_top, second_top;
};

/// What a scan's triangle shows.
enum class Class : std::uint8_t { wall, roof, ground, other };
[[nodiscard]] auto to_string(Class kind) -> std::string_view;
inline constexpr std::size_t class_count = 4;

/// Where a truth comes from that was not made of plans: what is known of it lies in that file.
struct ModelSource {
  struct Building {
    double top = 0;                          ///< z, metres, of its highest corner
    bool ground_faces = false;               ///< whether the model says what its ground is
    std::array<double, class_count> area{};  ///< m² of the model's faces, by Class
  };
  model::InputFile file;
  std::string lod;                  ///< as ingest::Model::lod
  std::vector<Building> buildings;  ///< one for each of the city
};

/// What is really there. Every part of the city is a plan, raised and labelled; every solid passed solid::check. Of a
/// model of another producer the city has ids, outlines and ground, and no parts.
struct Truth {
  model::City city;
  std::vector<PartyWall> party_walls;  ///< ordered by first, second, line
  std::optional<ModelSource> model;
};

/// A block with synthetic, plausible buildings about the origin. Guarantees: 1 every solid is extruded in full and
/// valid · 2 buildings do not overlap in plan · 3 the same kind, options and seed give the same truth at any thread
/// count. Fails with "simulate-solid" (with the id of the part), "cancelled".
[[nodiscard]] auto make_block(Kind kind, const BlockOptions& options, std::uint64_t seed, const base::Run& run = {})
    -> base::Result<Truth>;

/// Real footprints with invented, plausible profiles; features with a defect are left out, each with a warning appended
/// to `warnings`, as are those over which no solid can be extruded. Edges along neighbours are vertical.
/// Fails with "simulate-nothing" (no usable footprint), "cancelled".
[[nodiscard]] auto furnish(const model::Scene& footprints, const BlockOptions& options, std::uint64_t seed,
                           std::vector<base::Diagnostic>& warnings, const base::Run& run = {}) -> base::Result<Truth>;

/// Plan + profiles that are there already, as truth: every part is extruded again, buildings without a footprint get
/// that of their parts, and party walls are found. Fails as extrude::raise does (with the id of the part), and with
/// "geometry-boolean", "cancelled".
[[nodiscard]] auto truth_of(model::City plans, const base::Run& run = {}) -> base::Result<Truth>;

/// Where the scan is, against the outlines of that survey: the displacement the other way, metres.
[[nodiscard]] auto offset_of(const SurveyOptions& options, std::uint64_t seed) -> geometry::Point2;
/// m; root mean square of the length by which `jitter` moves a corner: jitter / √3. In one direction 1/√2 of that.
[[nodiscard]] auto offset_spread(const SurveyOptions& options) -> double;

/// The features that a surveyor would draw: one per building, or per group of merged ones, in the order of the
/// buildings. Attributes: id, buildings (the ids it represents, blanks between them).
/// Fails with "geometry-boolean".
[[nodiscard]] auto survey(const Truth& truth, const SurveyOptions& options, std::uint64_t seed)
    -> base::Result<std::vector<model::Footprint>>;

/// Surfaces of buildings, as triangles: what can be scanned. Where a building is closed along a vertical line, it is
/// solid inside; elsewhere it is solid from its highest surface down to the ground, so that walls may lack.
struct Surface {
  geometry::Mesh mesh;
  std::vector<Class> classes;            ///< per triangle
  std::vector<std::uint32_t> buildings;  ///< per triangle
  std::vector<std::uint32_t> faces;      ///< per triangle: which plane face of the model it belongs to
};
/// Fails with "geometry-triangulate".
[[nodiscard]] auto surface_of(const model::City& city) -> base::Result<Surface>;

/// The buildings of a model that meet the box, in metres of the file's frame.
[[nodiscard]] auto within(model::Model model, const geometry::Box2& box) -> model::Model;

struct ModelTruth {
  Truth truth;
  Surface surface;  ///< the model's own faces, and a floor under the buildings that have no ground
};
/// A model of any producer, as truth. Outlines are the ground faces seen from above; of a building without them, all
/// faces but walls, with a floor at its lowest corner ("simulate-model-ground" is appended to `warnings`). Party walls
/// are the stretches that two outlines share within 10 cm. A building turned inside out is turned back. Open buildings
/// and those without an outline, which are left out, are warned of: "simulate-model-open", "simulate-model-outline".
/// Guarantee: 1 buildings keep their ids and order. Fails with "simulate-nothing".
[[nodiscard]] auto truth_of(const model::Model& model, std::vector<base::Diagnostic>& warnings)
    -> base::Result<ModelTruth>;

/// A tree that was planted over a roof or within an outline.
struct Crown {
  geometry::Point3 centre;     ///< metres
  double radius = 0;           ///< m; single lumps reach 0.3 times as far again
  std::uint32_t building = 0;  ///< index into City::buildings
  bool within = false;         ///< whether its trunk is within the outline
};

/// The accuracy of a scan on roofs, as planted.
struct Accuracy {
  double noise = 0;            ///< m; root mean square along the normal, over the area of the roofs; no seams
  double correlated_area = 0;  ///< m²; over which the noise counts as one error; 0 without noise
  double spacing = 0;          ///< m; between vertices or points; 0 for the faces themselves
  double blur = 0;             ///< m; standard deviation of the Gaussian that smooths edges
};

/// m²; the area over which the noise of a scan counts as one error: the mean of the noise over a much larger area S has
/// the variance σ² · A / S. For noise of a wavelength (m) this is the integral of its autocorrelation over a horizontal
/// plane, A = 0.356 · noise_length²; over planes of other directions 0.350 to 0.359. With a spacing (m) of the samples
/// it is the sum of the autocorrelation over a grid, times the area of a cell: about spacing² for short waves, and
/// exactly that for independent noise (noise_length 0).
[[nodiscard]] auto correlated_area(double noise_length, double spacing = 0) -> double;

struct Scan {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  geometry::Mesh mesh;
  std::vector<Class> classes;            ///< per triangle
  std::vector<std::uint32_t> buildings;  ///< per triangle; none for ground and other
  std::vector<Crown> crowns{};           ///< by building, those beside it first
  Accuracy planted{};
  /// z of the ground along the open walls of a building, without trees and cars; its mean is by length.
  struct AtWalls {
    double lowest = 0, mean = 0, highest = 0;
  };
  std::vector<std::optional<AtWalls>> at_walls{};  ///< by building; none of one without open walls
};

/// A mesh as photogrammetry or laser scanning would give it of the buildings, the ground they stand on, and the trees,
/// cars and chimneys that nobody asked for. Walls between buildings are not in it. A scan that keeps_faces() has the
/// faces of the surface, without what another face covers, and triangles of ground around that meet them: what is
/// inside of overlapping solids stays. Guarantees: 1 without melt, noise,
/// bulge and losses, every vertex lies within `resolution` of the union of the solids and the ground · 2 the area of
/// walls lost to holes is the asked share to within one triangle · 3 the same input, options and seed give the same
/// bytes at any thread count · 4 the vertices of a scan that keeps_faces() are on the faces of the surface, within
/// 0.1 mm, or on the ground. Fails with "simulate-size" (more than 2²⁷ columns), "simulate-nothing" (no triangles),
/// "geometry-boolean", "geometry-triangulate", "cancelled". Cost: O(volume / resolution³), in pieces of 64 × 64
/// columns.
[[nodiscard]] auto scan(const Surface& surface, const ScanOptions& options, std::uint64_t seed,
                        const base::Run& run = {}) -> base::Result<Scan>;

/// Binary PLY in the file's frame: vertices as doubles, per face `class` (uchar, by the enumeration) and `building`
/// (int, −1 for none).
[[nodiscard]] auto ply(const Scan& scan, const model::Frame& frame) -> std::string;
/// GeoJSON in the file's frame, with its CRS where that is an EPSG code.
[[nodiscard]] auto geojson(const std::vector<model::Footprint>& footprints, const model::Frame& frame) -> std::string;
/// OBJ in the file's frame: an object per building of the city, its triangles in a group per class.
[[nodiscard]] auto surface_obj(const Surface& surface, const model::City& city) -> std::string;
/// What truly stands there, as features: the outline of every building, with id and ground.
[[nodiscard]] auto true_footprints(const Truth& truth) -> std::vector<model::Footprint>;
/// The accuracy of what was made: of the mesh, and of the points where there are any.
struct Planted {
  Accuracy mesh;
  std::optional<Accuracy> points;
  std::vector<Fault> faults{};
};
/// What the files beside it do not say: party walls, roofs of the buildings, crowns over them, options, seed, and the
/// accuracy and the faults that were planted. `source` names the kind of block or the file.
[[nodiscard]] auto truth_json(const Truth& truth, const std::vector<model::Footprint>& footprints,
                              const Options& options, const std::string& source, const std::vector<Crown>& crowns = {},
                              const std::optional<Planted>& planted = {}) -> std::string;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::simulate
