// Point clouds: from their files to the surface and the ground in the working CRS.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/cloud/classes.hpp"
#include "mansard/cloud/cloud.hpp"
#include "mansard/ingest/detail/cloud_density.hpp"
#include "mansard/ingest/detail/cloud_pieces.hpp"
#include "mansard/ingest/detail/mesh_files.hpp"
#include "mansard/ingest/detail/same_clouds.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Box2;
using geometry::Point3;

auto corners_of(const Box2& box) -> std::array<Point3, 4> {
  return {{{box.least.x, box.least.y, 0},
           {box.most.x, box.least.y, 0},
           {box.most.x, box.most.y, 0},
           {box.least.x, box.most.y, 0}}};
}

/// Square metres in the working CRS.
auto area_of(const Box2& box, const std::optional<crs::WayOfMesh>& way) -> double {
  auto corners = corners_of(box);
  if (way) way->take(corners);
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) twice += cross(xy(corners[i]), xy(corners[(i + 1) % 4]));
  return std::abs(twice) / 2;
}

auto finite(Point3 p) -> bool { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

auto percent(std::uint64_t part, std::uint64_t whole) -> std::string {
  return base::to_text(whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

/// What was read, and what of it cannot be used wherever it is.
struct Read {
  std::uint64_t points = 0, not_finite = 0, noise = 0, withheld = 0;
  std::array<std::uint64_t, 256> classes{};  ///< as they are in the files

  /// `as`: the class that the point's is taken for.
  void add(const formats::CloudPoint& p, std::uint8_t as) {
    ++points;
    ++classes[p.classification];
    if (!finite(p.position)) ++not_finite;
    else if (p.withheld) ++withheld;
    else if (as == 7 || as == 18) ++noise;
  }
  void include(const Read& o) {
    points += o.points;
    not_finite += o.not_finite;
    noise += o.noise;
    withheld += o.withheld;
    for (std::size_t c = 0; c < classes.size(); ++c) classes[c] += o.classes[c];
  }
  [[nodiscard]] auto usable() const -> std::uint64_t { return points - not_finite - noise - withheld; }
};

/// "120 are noise (class 7 or 18) and 3 are marked as withheld"
auto left_out_in_words(const Read& read) -> std::string {
  std::string out;
  for (const auto& [count, what] :
       {std::pair(read.noise, "are noise (class 7 or 18)"), std::pair(read.withheld, "are marked as withheld"),
        std::pair(read.not_finite, "have coordinates that are not finite numbers")})
    if (count > 0) out += (out.empty() ? "" : " and ") + std::to_string(count) + " " + what;
  return out;
}

/// Why no point came to be in a tile.
auto why_none(const Read& read) -> std::string {
  const std::string left_out = left_out_in_words(read);
  if (read.points > 0 && read.usable() == 0)
    return "none of its " + std::to_string(read.points) + " points that were read can be used: " + left_out +
           "; give a cloud whose buildings are not classified as noise";
  return "no point is in the box of the footprints or of --bbox; check --bbox, --crs and --mesh-offset" +
         (left_out.empty() ? std::string() : "; of the points that were read, " + left_out);
}

/// Why the points that were in a tile are no surface.
auto why_no_surface(const cloud::Counts& counts, double density, double cell) -> std::string {
  std::uint64_t plants = 0, wires = 0;
  for (const std::size_t kind : {3, 4, 5}) plants += counts.classes[kind];
  for (const std::size_t kind : {13, 14, 15, 16}) wires += counts.classes[kind];
  const std::string all = std::to_string(counts.points);
  if (plants + wires == counts.points)
    return "all its " + all + " points in the area are vegetation (classes 3 to 5: " + std::to_string(plants) +
           ") or wires and masts (classes 13 to 16: " + std::to_string(wires) +
           "); give a cloud whose buildings are not classified as these, or --cloud-buildings top";
  return "none of its " + all + " points (" + base::to_text(density, density < 0.1 ? 6 : 1) +
         " points/m²) can be a surface: they are vegetation or wires, or too few for a surface in cells of " +
         base::to_text(cell) + " m; check its CRS and unit, and cloud.isolated";
}

auto in_words(const cloud::Counts& counts, double density, double cell, bool ground, const std::string& classes)
    -> std::string {
  const auto tiles = counts.tiles_by_class + counts.tiles_by_shape;
  std::string buildings;
  if (counts.tiles_by_shape == 0) buildings = "class 6";
  else if (counts.tiles_by_class == 0) buildings = "shape, since there are too few points of class 6";
  else
    buildings = "class 6 in " + std::to_string(counts.tiles_by_class) + " of " + std::to_string(tiles) +
                " tiles and by shape in the others";
  return "a surface in cells of " + base::to_text(cell) + " m was made of " + std::to_string(counts.points) +
         " points (" + base::to_text(density, 1) + " points/m²): buildings by " + buildings + ", the ground " +
         (ground ? "by class 2" : "as the lowest of the surface") + "; of " + std::to_string(counts.cells) + " cells " +
         percent(counts.filled, counts.cells) + " were filled, and " + std::to_string(counts.isolated) +
         " heights were left out as isolated; classes read: " + classes;
}

}  // namespace

auto measured_plan(const formats::PointCloud& cloud, const base::Run& run) -> base::Result<Box2> {
  std::vector<Box2> boxes(cloud.pieces());
  const auto read = each_piece(cloud, run, [&](std::size_t i, const auto& points) {
    for (const auto& p : points)
      if (finite(p.position)) boxes[i].add(xy(p.position));
  });
  if (!read) return read.failure();
  Box2 all;
  for (const auto& box : boxes) all.include(box);
  return all;
}

auto MeshReading::surface_of_clouds(const std::optional<Box2>& within, const base::Run& run, MeshFiles& out)
    -> base::Result<std::vector<formats::MeshPiece>> {
  std::vector<Source*> clouds;
  for (auto& source : sources_)
    if (source.cloud) clouds.push_back(&source);
  if (clouds.empty()) return std::vector<formats::MeshPiece>();
  const std::string subject = clouds.front()->path.string() + (clouds.size() > 1 ? " and others" : "");
  const auto map = cloud::class_map(options_.cloud);
  if (!map) return map.failure();

  // The same for every part of the clouds that is read: of all files, the middle one. Of a folder with more files than
  // these, those in the middle are not cut out of anything, and their headers are right.
  constexpr std::size_t few = 8;
  std::vector<double> densities;
  std::uint64_t stated = 0;
  std::size_t without_place = 0, flat = 0;
  for (const auto* source : clouds) {
    const auto& info = source->cloud->info();
    if (info.points == 0) continue;
    stated += info.points;
    Box2 plan;
    if (info.stated_bounds) plan = info.stated_bounds->plan();
    double area = plan.empty() ? 0 : area_of(plan, source->way);
    if (!(area > 0)) {
      const auto box = measured_plan(*source->cloud, run);
      if (!box) return box.failure();
      area = box->empty() ? 0 : area_of(*box, source->way);
      ++(box->empty() ? without_place : flat);
    }
    if (!(area > 0)) continue;
    densities.push_back(static_cast<double>(info.points) / area);
    if (clouds.size() > few) continue;
    const auto seen = density_where_points_are(*source->cloud, source->way, run);
    if (!seen) return seen.failure();
    densities.back() = std::max(densities.back() * seen->share_of_once, seen->density);
  }
  const auto none = [&](const std::string& what) { return base::error("ingest-points-empty", what, subject); };
  if (densities.empty()) {
    const std::string all = std::to_string(stated);
    if (stated == 0) return none("there are no points in it; check what it is");
    if (flat == 0)
      return none("none of its " + all + " points has coordinates that are finite numbers; export it again");
    return none("its " + all +
                " points are at one place, or on one line along an axis, which is no surface; check scale and "
                "coordinates, or export it again");
  }
  std::ranges::sort(densities);
  const double density = densities[densities.size() / 2];
  const double cell = cloud::cell_for(density, options_.cloud);
  auto opened = cloud::Surface::open(cell, options_.cloud);
  if (!opened) return opened.failure();
  auto& surface = **opened;

  Read read;
  std::vector<NamedFingerprint> fingerprints;
  std::mutex mutex;
  std::uint64_t opened_points = 0;
  for (const auto* source : clouds) {
    // Between what read_scene reports before and after.
    run.report("ingest", source->path.string(),
               0.5 + 0.2 * static_cast<double>(opened_points) / static_cast<double>(stated));
    opened_points += source->cloud->info().points;
    std::optional<Box2> box = within;
    if (box) {
      const double side = surface.side();
      const auto down = [&](double c) { return std::floor(c / side) * side; };
      const auto up = [&](double c) { return std::ceil(c / side) * side; };
      // Tiles are made of all their points, and of those around them.
      box = Box2{{down(box->least.x), down(box->least.y)}, {up(box->most.x), up(box->most.y)}}.grown(side / 4);
      if (source->way) box = source->way->back(*box);
    }
    const auto& cloud = *source->cloud;
    // Of one file the header's box is a hint; of a folder of tiles it says which to read.
    const auto& said = cloud.info().stated_bounds;
    if (box && clouds.size() > 1 && said && !said->plan().overlaps(*box)) continue;
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < cloud.pieces(); ++i) {
      const auto own = cloud.box_of(i);
      if (!box || !own || own->plan().overlaps(*box)) wanted.push_back(i);
    }
    auto& fingerprint = fingerprints.emplace_back(source->path.string(), Fingerprint{}).of;
    std::vector<std::optional<base::Failure>> failures(wanted.size());
    base::parallel_for(wanted.size(), [&](std::size_t i) {
      if (run.cancelled()) return;
      const auto points = cloud.read(wanted[i]);
      if (!points) {
        failures[i] = points.failure();
        return;
      }
      std::vector<Point3> positions;
      positions.reserve(points->size());
      for (const auto& p : *points) positions.push_back(p.position);
      if (source->way) source->way->take(positions);
      std::vector<cloud::Sample> samples;
      samples.reserve(points->size());
      Read own;
      Fingerprint own_print;
      for (std::size_t k = 0; k < points->size(); ++k) {
        const auto& p = (*points)[k];
        const std::uint8_t as = (*map)[p.classification];
        own.add(p, as);
        own_print.add(positions[k], as);
        if (!p.withheld) samples.push_back({positions[k], as, p.return_number, p.returns, p.source});
      }
      surface.add(samples, within);
      const std::scoped_lock lock(mutex);
      read.include(own);
      fingerprint.include(own_print);
    });
    if (run.cancelled()) return base::stopped();
    for (const auto& failure : failures)
      if (failure) return *failure;
    auto inputs = cloud.inputs();
    if (!inputs) return inputs.failure();
    out.inputs.insert(out.inputs.end(), inputs->begin(), inputs->end());
  }

  const auto tiles = surface.tiles();
  std::vector<formats::MeshPiece> pieces(tiles.size());
  std::vector<cloud::GroundTile> grounds(tiles.size());
  cloud::Counts counts;
  cloud::StripOverlaps strips;
  base::parallel_for(tiles.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    auto made = surface.make(tiles[i]);
    if (!made) {
      pieces[i].failure = made.error();
      return;
    }
    pieces[i].mesh.vertices = std::move(made->mesh.vertices);
    pieces[i].mesh.triangles = std::move(made->mesh.triangles);
    pieces[i].mesh.points = std::move(made->mesh.points);
    grounds[i] = std::move(made->ground);
    if (cells_ != nullptr) into_cells(pieces[i]);
    const std::scoped_lock lock(mutex);
    counts.include(made->counts);
    strips.include(made->strips);
  });
  if (run.cancelled()) return base::stopped();
  for (const auto& piece : pieces)
    if (piece.failure) return *piece.failure;
  if (counts.points == 0) return none(why_none(read));
  const bool any = std::ranges::any_of(
      pieces, [](const auto& piece) { return !piece.mesh.triangles.empty() || piece.triangles > 0; });
  if (!any) return none(why_no_surface(counts, density, cell));
  Box2 area;
  for (const auto& tile : grounds)
    if (!tile.heights.empty()) area.add({static_cast<double>(tile.x), static_cast<double>(tile.y)});
  constexpr double most_ground = 1e9;  // cells of 1 m, of 4 bytes
  if (const auto extent = area.most - area.least; !area.empty() && extent.x * extent.y > most_ground)
    return base::error("ingest-memory",
                       "ground points are " + base::to_text(length(extent) / 1000, 0) +
                           " km apart; give --crs where the clouds name different CRSs, leave out files that are "
                           "elsewhere, or give footprints and the part of them to read with --bbox",
                       subject);
  out.ground = cloud::join(grounds, options_.cloud.ground_reach);
  for (auto& tile : grounds) tile.heights = {};
  out.roofs_only = clouds.size() == sources_.size() && counts.tiles_by_shape == 0 && !cloud::any_ground(counts.classes);
  out.counted = std::move(grounds);
  warnings_.push_back(base::warning(
      "ingest-points-surface",
      in_words(counts, density, cell, out.ground.has_value(), cloud::classes_in_words(read.classes, *map)), subject));
  if (auto twice = repeated_in_words(fingerprints, counts); !twice.empty())
    warnings_.push_back(base::warning("ingest-points-twice", std::move(twice), subject));
  if (const auto differ = cloud::differences_in_words(cloud::strip_differences(strips)); !differ.empty())
    warnings_.push_back(base::warning(
        "ingest-points-strips",
        "flight strips (point source IDs) differ in height: " + differ + "; heights of models are between them",
        subject));
  if (const auto unknown = cloud::unknown_classes(read.classes, *map); !unknown.empty())
    warnings_.push_back(base::warning(
        "ingest-points-classes",
        "classes without a meaning in LAS 1.4: " + unknown +
            "; where buildings are found by class they are left out. If they are buildings or ground, give "
            "--cloud-building-classes or --cloud-ground-classes with all classes of these, and "
            "--cloud-left-out-classes "
            "for what is neither",
        subject));
  return pieces;
}

}  // namespace mansard::ingest::detail
