// The steps of reading: the mesh, the features, the transformation to one frame, and the removal of faults.
#include "mansard/ingest/ingest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <utility>

#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/cloud/classes.hpp"
#include "mansard/cloud/density.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/raster/raster.hpp"
#include "mansard/formats/vector/attributes.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/ingest/detail/clean.hpp"
#include "mansard/ingest/detail/crs.hpp"
#include "mansard/ingest/detail/files_below.hpp"
#include "mansard/ingest/detail/mesh_files.hpp"
#include "mansard/ingest/detail/origin.hpp"
#include "mansard/ingest/detail/parts.hpp"
#include "mansard/ingest/detail/rings.hpp"
#include "mansard/ingest/detail/surroundings.hpp"

namespace mansard::ingest {
namespace {

using geometry::Box2;
using geometry::Point2;

/// Around the footprints that --bbox keeps, so much of the mesh stays: more than any later stage looks at.
constexpr double mesh_margin = 50;

auto in_words(const Box2& box) -> std::string {
  return "x " + base::to_text(box.least.x, 1) + " to " + base::to_text(box.most.x, 1) + ", y " +
         base::to_text(box.least.y, 1) + " to " + base::to_text(box.most.y, 1);
}

/// The features of a source with their ids, and which of them are asked for.
struct Chosen {
  formats::FeatureFile file;
  std::vector<std::string> ids;
  std::map<std::string, std::string> part_prefixes;  ///< by id, where they are not the usual ones
  std::vector<bool> wanted;
};

auto read_chosen(const std::filesystem::path& path, const Options& options, const base::Run& run)
    -> base::Result<Chosen> {
  // What does not pass the filter is still around what does.
  auto file = formats::read_features(
      path, {options.layer, options.where, true, options.crs, options.bbox, options.encoding}, run);
  if (!file) return file.failure();
  // Before any is left out: of ids that are there twice, what a selection calls them is what the whole file calls them.
  auto ids = formats::ids_of(file->features, options.id_attribute, formats::shown_name(path), file->warnings);
  if (!ids) return ids.failure();
  Chosen out{std::move(*file), std::move(*ids), {}, {}};
  out.part_prefixes = formats::part_prefixes_of(out.ids);
  for (const auto& feature : out.file.features) out.wanted.push_back(feature.passes);
  return out;
}

auto want_within(Chosen& chosen, const Box2& box, const std::string& subject) -> base::Result<void> {
  bool any = false;
  Box2 all;
  for (std::size_t i = 0; i < chosen.wanted.size(); ++i) {
    if (!chosen.wanted[i]) continue;
    const Box2 own = bounds(chosen.file.features[i]);
    all.include(own);
    chosen.wanted[i] = !own.empty() && own.overlaps(box);
    any = any || chosen.wanted[i];
  }
  if (any) return {};
  return base::error("ingest-footprints-none",
                     "no footprint lies in the box asked for (" + in_words(box) + "); they lie in " + in_words(all),
                     subject);
}

/// The bounds of the wanted features and of what they touch. Leaves only these and what is near them.
auto keep_surroundings(Chosen& chosen) -> Box2 {
  auto& features = chosen.file.features;
  const auto box_of_marked = [&](const std::vector<bool>& marked) {
    Box2 box;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (!marked[i]) continue;
      box.include(bounds(features[i]));
    }
    return box;
  };
  if (std::ranges::find(chosen.wanted, false) == chosen.wanted.end()) return box_of_marked(chosen.wanted);
  std::vector<bool> near = chosen.wanted;
  detail::close_under_touching(features, near);
  const Box2 blocks = box_of_marked(near);
  const Box2 reach = blocks.grown(mesh_margin);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!chosen.wanted[i] && !bounds(features[i]).overlaps(reach)) continue;
    if (kept != i) {
      features[kept] = std::move(features[i]);
      chosen.ids[kept] = std::move(chosen.ids[i]);
    }
    chosen.wanted[kept++] = chosen.wanted[i];
  }
  features.resize(kept);
  chosen.ids.resize(kept);
  chosen.wanted.resize(kept);
  return blocks;
}

auto defect_without_polygons(const formats::RawFeature& feature) -> base::Diagnostic {
  if (feature.other_geometry)
    return base::error("ingest-footprint-type",
                       "it is a " + feature.geometry + ", not a polygon; convert it in the source");
  if (!feature.failure.empty())
    return base::error("ingest-footprint-unreadable",
                       "it cannot be read (" + feature.failure + "); correct it in the source");
  return base::error("ingest-footprint-empty", "it has no geometry; remove it, or draw it in the source");
}

constexpr double largest_building = 5000;  // m; the longest there is has 3 km

/// One footprint in the local frame, with what there is to say about it.
struct Finished {
  model::Footprint footprint;
  std::optional<base::Diagnostic> warning;
};

auto finish(formats::RawFeature feature, std::string id, const model::Frame& frame, const Box2& mesh) -> Finished {
  Finished out;
  auto& footprint = out.footprint;
  footprint.id = std::move(id);
  footprint.attributes = std::move(feature.attributes);
  footprint.outline_z = feature.lowest;
  const auto refuse = [&](base::Diagnostic why) {
    why.subject = footprint.id;
    footprint.defect = std::move(why);
  };
  if (feature.parts.empty()) {
    refuse(defect_without_polygons(feature));
    return out;
  }
  const std::array<double, 2> origin{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])};
  Box2 box;
  for (auto& part : feature.parts)
    for (auto& ring : part)
      for (auto& p : ring) {
        p = {p.x - origin[0], p.y - origin[1]};
        box.add(p);
      }
  auto repaired = detail::repair(feature.parts, origin);
  if (repaired.defect) {
    refuse(std::move(*repaired.defect));
  } else if (const double side = std::max(box.most.x - box.least.x, box.most.y - box.least.y);
             side > largest_building) {
    refuse(base::error(
        "ingest-footprint-size",
        "it is " + base::to_text(side, 0) + " m long, longer than any building; check its coordinates and CRS"));
  } else if (!box.overlaps(mesh)) {
    refuse(base::error("ingest-footprint-outside",
                       "it is outside of the scan; give the scan there, or choose others with --bbox"));
    footprint.polygons = std::move(repaired.polygons);  // written as LoD 0
  } else {
    footprint.polygons = std::move(repaired.polygons);
    if (feature.other_geometry) repaired.repairs.push_back("points, lines or solids beside its polygons were left out");
    std::string all;
    for (const auto& words : repaired.repairs) all += (all.empty() ? "" : ", ") + words;
    if (!all.empty()) out.warning = base::warning("ingest-footprint-repaired", all, footprint.id);
  }
  return out;
}

void append(std::vector<base::Diagnostic>& all, std::vector<base::Diagnostic> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// All features of the file as footprints. Where their polygons are beside `mesh`, they have a defect. Not all at once:
/// what was read of a feature goes when its footprint is made.
void finish_all(Chosen& chosen, const Box2& mesh, model::Scene& scene) {
  auto& features = chosen.file.features;
  auto& ids = chosen.ids;
  const auto wanted = static_cast<std::size_t>(std::ranges::count(chosen.wanted, true));
  scene.footprints.reserve(wanted);
  scene.surroundings.reserve(features.size() - wanted);
  constexpr std::size_t at_once = 8192;
  std::vector<Finished> finished;
  for (std::size_t first = 0; first < features.size(); first += at_once) {
    finished.assign(std::min(at_once, features.size() - first), {});
    base::parallel_for(finished.size(), [&](std::size_t i) {
      finished[i] = finish(std::exchange(features[first + i], {}), std::move(ids[first + i]), scene.frame, mesh);
    });
    for (std::size_t i = 0; i < finished.size(); ++i) {
      auto& one = finished[i];
      if (const auto found = chosen.part_prefixes.find(one.footprint.id); found != chosen.part_prefixes.end())
        one.footprint.part_prefix = found->second;
      const bool asked = chosen.wanted[first + i];
      if (asked && one.warning) scene.warnings.push_back(std::move(*one.warning));
      (asked ? scene.footprints : scene.surroundings).push_back(std::move(one.footprint));
    }
  }
  features = {};
}

/// The footprints in the working CRS, and what it is.
struct Ground {
  Chosen chosen;  ///< without features where no footprints are given
  detail::Way way;
  Box2 box;                  ///< of the features asked for and of all that they touch; empty for none
  std::optional<Box2> kept;  ///< what of the mesh is to be read; nothing for all of it
};

auto read_ground(const std::filesystem::path& path, const Options& options, const detail::MeshReading& meshes,
                 const base::Run& run) -> base::Result<Ground> {
  const std::string subject = formats::shown_name(path);
  const auto wanted = box_of(options);
  if (!wanted) return wanted.error();
  const auto& within = *wanted;
  Ground out;
  if (path.empty()) {
    auto way = detail::way_without_features(options.crs, meshes.own_crs_or_zone());
    if (!way) return way.error();
    out.way = std::move(*way);
  } else {
    auto chosen = read_chosen(path, options, run);
    if (!chosen) return chosen.failure();
    auto way = detail::choose_way(chosen->file, options.crs, meshes.plan(), meshes.own_crs(), subject);
    if (!way) return way.failure();
    if (auto gone = detail::go(*way, chosen->file.features, subject); !gone) return gone.failure();
    if (within)
      if (auto any = want_within(*chosen, *within, subject); !any) return any.failure();
    out.box = keep_surroundings(*chosen);
    out.chosen = std::move(*chosen);
    out.way = std::move(*way);
  }
  if (within) {
    auto& kept = out.kept.emplace(*within);
    if (!out.box.empty()) {
      kept.add(out.box.least);
      kept.add(out.box.most);
    }
    kept = kept.grown(mesh_margin);
  }
  return out;
}

/// Whether two boxes share half of the smaller one.
auto share_half(const Box2& a, const Box2& b) -> bool {
  const auto area = [](const Box2& box) {
    return std::max(0.0, box.most.x - box.least.x) * std::max(0.0, box.most.y - box.least.y);
  };
  const Box2 both{{std::max(a.least.x, b.least.x), std::max(a.least.y, b.least.y)},
                  {std::min(a.most.x, b.most.x), std::min(a.most.y, b.most.y)}};
  return 2 * area(both) >= std::min(area(a), area(b)) && area(both) > 0;
}

/// What would make mesh and footprints overlap: another axis that is up, another unit, or x and y swapped. Empty for
/// none of them. `mesh`: as read, with the offset; `y_up`: it was turned when it was read.
auto mended(const Box2& footprints, const geometry::Box3& mesh, const std::array<double, 3>& offset, bool y_up)
    -> std::string {
  using geometry::Point3;
  const Point3 by{offset[0], offset[1], offset[2]};
  const auto overlap = [&](auto change) {
    geometry::Box3 box;
    for (const Point3 corner : {mesh.least, mesh.most}) box.add(change(corner - by) + by);
    return share_half(box.plan(), footprints);
  };
  struct Way {
    double factor;
    const char* words;
  };
  constexpr double foot = 0.3048;
  constexpr std::array ways{
      Way{foot, "the mesh is in feet, and they do in metres: multiply its coordinates by 0.3048"},
      Way{1 / foot,
          "the footprints are in feet, or the mesh was divided by 3.2808: multiply its coordinates by 3.2808"},
      Way{0.001, "the mesh is in millimetres, and they do in metres: multiply its coordinates by 0.001"},
      Way{0.01, "the mesh is in centimetres, and they do in metres: multiply its coordinates by 0.01"},
      Way{1000, "the mesh is in kilometres, and they do in metres: multiply its coordinates by 1000"}};
  if (overlap([](Point3 p) { return Point3{p.y, p.x, p.z}; }))
    return "with x and y of one swapped they do: correct its axis order";
  if (overlap([](Point3 p) { return Point3{p.x, -p.z, p.y}; }))
    return y_up ? "with its z axis down they do: turn it by 180° about its x axis and give --up z"
                : "with y up they do: give --up y";
  if (overlap([](Point3 p) { return Point3{p.x, p.z, -p.y}; }))
    return y_up ? "with z up they do: give --up z"
                : "with y up and mirrored they do: multiply its z by -1 and give --up y";
  if (overlap([](Point3 p) {
        return Point3{-p.z, p.y, p.x};
      }) ||
      overlap([](Point3 p) {
        return Point3{p.z, p.y, -p.x};
      }))
    return "the mesh lies on its side, and with its x axis up they do: turn it before it is read";
  // m: from a house to a city among mountains. Any mesh near the origin reaches far if it is a thousand times as large.
  constexpr double least_height = 1, most_height = 3000;
  for (const auto& way : ways) {
    const double height = way.factor * (mesh.most.z - mesh.least.z);
    if (height >= least_height && height <= most_height && overlap([&](Point3 p) { return way.factor * p; }))
      return way.words;
  }
  return {};
}

auto check_overlap(const Ground& ground, const geometry::Box3& box, const Options& options,
                   const std::vector<model::InputFile>& inputs, const std::string& subject) -> base::Result<void> {
  const Box2 mesh = box.plan();
  if (ground.box.empty() || ground.box.overlaps(mesh)) return {};
  const std::string& crs = ground.way.name;
  const auto how = mended(ground.box, box, options.mesh_offset, is_read_y_up(options, inputs));
  return base::error("ingest-no-overlap",
                     "mesh and footprints do not overlap: the mesh lies in " + in_words(mesh) + ", the footprints in " +
                         in_words(ground.box) + (crs.empty() ? "" : " (" + crs.substr(0, crs.find('[')) + ")") +
                         (how.empty() ? "; give --mesh-offset or --crs" : "; " + how),
                     subject);
}

/// The ground's heights, where they are given or point clouds have them, around what is kept of the mesh.
auto take_terrain(const Options& options, const Box2& around, std::optional<cloud::Ground> ground, model::Scene& scene)
    -> base::Result<void> {
  if (options.terrain.empty()) {
    if (!ground) return {};
    // Cells of 1 m, whose centres are half a metre from their corners.
    const auto at = [&](std::int64_t corner, std::size_t axis) {
      return static_cast<double>(corner - scene.frame.origin[axis]) + 0.5 + options.mesh_offset[axis];
    };
    model::HeightGrid grid{{at(ground->x, 0), at(ground->y, 1)},
                           1,
                           ground->columns,
                           ground->rows,
                           std::move(ground->heights),
                           static_cast<double>(scene.frame.origin[2]) - options.mesh_offset[2]};
    scene.terrain = std::make_shared<const model::HeightGrid>(std::move(grid));
    return {};
  }
  constexpr double beside = 100;  // m; --terrain-margin may ask for more, where the terrain is continued
  auto terrain = formats::read_terrain(options.terrain, scene.frame, around.grown(beside));
  if (!terrain) return terrain.error();
  scene.terrain = std::make_shared<const model::HeightGrid>(std::move(*terrain));
  auto input = formats::input_file(options.terrain);
  if (!input) return input.error();
  scene.inputs.push_back(std::move(*input));
  return {};
}

/// What point clouds have over each footprint.
void take_density(std::vector<cloud::GroundTile> counted, const Options& options, model::Scene& scene) {
  if (counted.empty()) return;
  const cloud::Density density(std::move(counted));
  const Point2 origin{static_cast<double>(scene.frame.origin[0]) - options.mesh_offset[0],
                      static_cast<double>(scene.frame.origin[1]) - options.mesh_offset[1]};
  base::parallel_for(scene.footprints.size(), [&](std::size_t f) {
    auto& attributes = scene.footprints[f].attributes;
    const auto value = density.over(scene.footprints[f].polygons, origin);
    if (!value) return;
    std::erase_if(attributes, [](const auto& one) { return one.first == "ms_point_density"; });
    attributes.emplace_back("ms_point_density", *value);
  });
}

/// Says which classes have the points of buildings, and are not used for them.
void tell_undecided(const std::vector<cloud::GroundTile>& tiles, const Options& options, model::Scene& scene) {
  if (!scene.terrain || scene.footprints.empty()) return;
  std::vector<Box2> boxes;
  for (const auto& footprint : scene.footprints) boxes.push_back(geometry::bounds(footprint.polygons));
  const geometry::BoxIndex index(boxes);
  const auto along = [&](std::size_t axis) {
    return options.mesh_offset[axis] - static_cast<double>(scene.frame.origin[axis]);
  };
  const Point2 shift{along(0), along(1)};
  constexpr double high = 2;                                          // m above the ground: no car and no hedge
  std::map<std::uint8_t, std::map<std::size_t, std::uint64_t>> over;  // by class and footprint
  for (const auto& tile : tiles)
    for (const auto& some : tile.undecided) {
      const Point2 at =
          shift + Point2{static_cast<double>(tile.x) + static_cast<double>(some.cell % tile.columns) + 0.5,
                         static_cast<double>(tile.y) + static_cast<double>(some.cell / tile.columns) + 0.5};
      for (const auto f : index.overlapping({at, at})) {
        if (!geometry::contains(scene.footprints[f].polygons, at)) continue;
        const auto ground = scene.terrain->at(at);
        if (ground && static_cast<double>(some.height) + along(2) - *ground >= high)
          over[some.classification][f] += some.points;
      }
    }
  if (over.empty()) return;
  std::vector<double> points;
  for (const auto& footprint : scene.footprints) {
    double area = 0;
    for (const auto& polygon : footprint.polygons) area += geometry::area(polygon);
    const auto density =
        std::ranges::find(footprint.attributes, "ms_point_density", &model::Attributes::value_type::first);
    const auto* value = density == footprint.attributes.end() ? nullptr : std::get_if<double>(&density->second);
    points.push_back(value == nullptr ? 0 : *value * area);
  }
  double all = 0;
  for (const double one : points) all += one;
  for (const auto& [classification, footprints] : over) {
    // A building of which most points are of the class; less is a wall, a crown, or what is on a roof.
    constexpr double most = 0.5;
    double sum = 0;
    std::size_t buildings = 0;
    for (const auto& [f, count] : footprints) {
      sum += static_cast<double>(count);
      if (static_cast<double>(count) > most * points[f]) ++buildings;
    }
    if (buildings == 0) continue;
    const auto number = std::to_string(classification);
    const auto name = cloud::class_name(classification);
    scene.warnings.push_back(base::warning(
        "scan-classes",
        "class " + number + (name.empty() ? "" : " (" + std::string(name) + ")") + " has " +
            base::to_text(100 * sum / all, 0) +
            " % of the points over the footprints, 2 m or more above the ground, and " + "most of those of " +
            std::to_string(buildings) + " of " + std::to_string(scene.footprints.size()) +
            " footprints, but is not used for buildings; if it has roofs, give --cloud-building-classes " +
            options.cloud.building_classes + "," + number));
  }
}

auto plan_of(const geometry::Mesh& mesh) -> Box2 { return Box2::of(mesh.vertices); }

auto moved(const geometry::Box3& box, const std::array<double, 3>& by) -> geometry::Box3 {
  if (box.empty()) return box;
  const geometry::Point3 shift{by[0], by[1], by[2]};
  return {box.least + shift, box.most + shift};
}

/// Of the meshes on this machine's disk; tilesets and EPT are the folder that they are in.
auto bytes_of(const std::vector<std::filesystem::path>& paths) -> std::uintmax_t {
  namespace fs = std::filesystem;
  std::uintmax_t sum = 0;
  std::error_code failure;
  const auto add = [&](const fs::path& file) {
    // A compressed point takes about a sixth of what the surface made of it does; others as much.
    constexpr std::uintmax_t laz = 6;
    const auto size = fs::file_size(file, failure);
    if (!failure) sum += formats::extension_of(file) == ".laz" ? laz * size : size;
  };
  for (const auto& path : paths) {
    const bool in_folder = path.filename() == "tileset.json" || path.filename() == "ept.json";
    const auto folder = in_folder ? (path.has_parent_path() ? path.parent_path() : fs::path(".")) : path;
    if (!fs::is_directory(folder, failure)) {
      add(path);
      continue;
    }
    if (const auto files = detail::files_below(folder); files) std::ranges::for_each(*files, add);
    // else reading it says why it cannot be listed
  }
  return sum;
}

/// With `cells`, the mesh goes there, and the scene has none.
auto read(const std::vector<std::filesystem::path>& mesh_paths, const std::filesystem::path& footprint_path,
          const Options& options, const base::Run& run, MeshCells* cells = nullptr) -> base::Result<model::Scene> {
  const std::string subject = formats::shown_name(footprint_path);
  const std::string mesh_name = mesh_paths.empty() ? std::string() : mesh_paths.front().string();
  if (const auto wanted = box_of(options); !wanted) return wanted.error();
  run.report("ingest", mesh_name, 0);
  auto reading = detail::MeshReading::open(mesh_paths, options, run, cells);
  if (!reading) return reading.error();
  run.report("ingest", subject, 0.4);
  auto ground = read_ground(footprint_path, options, *reading, run);
  if (!ground) return ground.error();
  run.report("ingest", mesh_name, 0.5);
  auto meshes = reading->finish(ground->way.name, ground->kept, run);
  if (!meshes) return meshes.error();
  const geometry::Box3 mesh_box =
      cells == nullptr ? detail::bounds(meshes->mesh, options.mesh_offset) : moved(cells->box(), options.mesh_offset);
  if (mesh_box.empty())
    return base::error(
        "ingest-mesh-unusable",
        "none of the " + std::to_string(meshes->mesh.triangles.size()) +
            " triangles has corners that exist and are finite and near enough to zero; export the mesh again. "
            "Coordinates in millimetres must be multiplied by 0.001",
        mesh_name);
  if (auto met = check_overlap(*ground, mesh_box, options, meshes->inputs, subject); !met) return met.error();
  model::Scene scene;
  scene.frame.crs = ground->way.name;
  scene.frame.origin =
      detail::origin_of(!ground->box.empty() ? ground->box : ground->kept.value_or(mesh_box.plan()), mesh_box);

  run.report("ingest", mesh_name, 0.7);
  std::array<double, 3> shift{};
  for (std::size_t i = 0; i < 3; ++i) shift[i] = options.mesh_offset[i] - static_cast<double>(scene.frame.origin[i]);
  const Point2 origin{static_cast<double>(scene.frame.origin[0]), static_cast<double>(scene.frame.origin[1])};
  std::optional<Box2> within;
  if (const auto& kept = ground->kept) within = Box2{kept->least - origin, kept->most - origin};
  if (cells == nullptr) {
    auto clean = detail::clean(std::move(meshes->mesh), shift, within, {}, run);
    if (run.cancelled()) return base::stopped();
    scene.mesh = std::move(clean.mesh);
    scene.mesh_counts = clean.counts;
  } else {
    const auto counts = cells->settle(shift, within, run);
    if (!counts) return counts.failure();
    scene.mesh_counts = *counts;
    scene.mesh_counts.vertices_read = meshes->vertices_read;  // several pieces of a file can have the same vertices
  }
  if (scene.mesh_counts.triangles == 0)
    return base::error("ingest-mesh-unusable", "no triangle has an area; export the mesh again", mesh_name);
  if (run.cancelled()) return base::stopped();

  run.report("ingest", subject, 0.9);
  const Box2 local{xy(mesh_box.least) - origin, xy(mesh_box.most) - origin};
  scene.inputs = std::move(meshes->inputs);
  scene.roofs_only = meshes->roofs_only;
  const Box2 ground_box = cells == nullptr ? plan_of(scene.mesh) : within ? within->grown(mesh_margin) : local;
  if (auto taken = take_terrain(options, ground_box, std::move(meshes->ground), scene); !taken) return taken.error();
  scene.inputs.insert(scene.inputs.end(), ground->chosen.file.inputs.begin(), ground->chosen.file.inputs.end());
  append(scene.warnings, std::move(meshes->warnings));
  append(scene.warnings, detail::warnings_of(scene.mesh_counts, mesh_name));
  append(scene.warnings, std::move(ground->chosen.file.warnings));
  append(scene.warnings, ground->way.warnings);
  finish_all(ground->chosen, local, scene);
  detail::join_parts(scene, subject, scene.warnings);
  std::vector<cloud::GroundTile> undecided;  // without the cells, which are large
  for (auto& tile : meshes->counted)
    undecided.push_back({tile.x, tile.y, tile.columns, tile.rows, {}, {}, std::move(tile.undecided)});
  take_density(std::move(meshes->counted), options, scene);
  tell_undecided(undecided, options, scene);
  run.report("ingest", subject, 1);
  return scene;
}

auto read_alone(const std::filesystem::path& path, const Options& options, const base::Run& run)
    -> base::Result<model::Scene> {
  const std::string subject = formats::shown_name(path);
  const auto wanted = box_of(options);
  if (!wanted) return wanted.error();
  run.report("ingest", subject, 0);
  auto chosen = read_chosen(path, options, run);
  if (!chosen) return chosen.failure();
  auto* const file = &chosen->file;
  // Without a mesh to lie on, the footprints' own place stands for it.
  const auto way = detail::choose_way(*file, options.crs, bounds(file->features), {}, subject);
  if (!way) return way.error();
  if (auto gone = detail::go(*way, file->features, subject); !gone) return gone.error();
  if (const auto& within = *wanted)
    if (auto any = want_within(*chosen, *within, subject); !any) return any.failure();

  model::Scene scene;
  const Box2 box = keep_surroundings(*chosen);
  scene.frame.crs = way->name;
  if (!box.empty())
    scene.frame.origin = detail::origin_of(box, {{box.least.x, box.least.y, 0}, {box.most.x, box.most.y, 0}});
  constexpr double far = std::numeric_limits<double>::infinity();
  scene.inputs = std::move(file->inputs);
  if (!options.terrain.empty()) {
    const Point2 origin{static_cast<double>(scene.frame.origin[0]), static_cast<double>(scene.frame.origin[1])};
    const Box2 local{box.least - origin, box.most - origin};
    if (auto taken = take_terrain(options, local, std::nullopt, scene); !taken) return taken.error();
  }
  append(scene.warnings, std::move(file->warnings));
  append(scene.warnings, way->warnings);
  finish_all(*chosen, {{-far, -far}, {far, far}}, scene);
  detail::join_parts(scene, subject, scene.warnings);
  return scene;
}

/// What a library throws on bad files must not get past this module.
template <class Work>
auto guarded(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
             const Work& work) -> base::Result<model::Scene> {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "mesh and footprints do not fit into memory; cut the mesh into tiles",
                       meshes.empty() ? std::string() : meshes.front().string());
  } catch (const std::exception& e) {
    return base::error("ingest-footprints-format", std::string("cannot be read (") + e.what() + "); check what it is",
                       formats::shown_name(footprints));
  }
}

}  // namespace

auto read_city(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
               const Options& options, const base::Run& run) -> base::Result<CityScene> {
  CityScene out;
  constexpr double megabyte = 1e6;
  if (static_cast<double>(bytes_of(meshes)) >= options.cells_from * megabyte) {
    auto cells = MeshCells::open(options.cell_side);
    if (!cells) return cells.failure();
    out.cells = std::move(*cells);
  }
  auto scene = guarded(meshes, footprints, [&] { return read(meshes, footprints, options, run, out.cells.get()); });
  if (!scene) return scene.failure();
  out.scene = std::move(*scene);
  return out;
}

auto option_list(Options& o) -> base::OptionList {
  constexpr double far = 1e8;
  base::OptionList list("ingest");
  list.numbers("mesh_offset", o.mesh_offset, "m", {-far, far}, "Offset added to the mesh's x, y and z.")
      .alias("mesh_offset")
      .source("none by default");
  list.choice("up", o.up,
              {{"automatic", formats::UpAxis::automatic}, {"z", formats::UpAxis::z}, {"y", formats::UpAxis::y}},
              "Axis of the mesh that is up; automatic means y for glTF and z for the rest.")
      .alias("up")
      .source("glTF 2.0 specification: y; z as in GIS for the rest");
  list.string("crs", o.crs, "CRS to work in: EPSG:n, or local; empty for the footprints', the mesh's, or the UTM zone.")
      .alias("crs")
      .source("none by default");
  list.string("id_attribute", o.id_attribute, "Attribute that names a footprint; empty to look for a well-known one.")
      .alias("id_attribute")
      .source("none by default");
  list.string("layer", o.layer, "Layer of the vector file; empty for its first one with polygons.")
      .alias("layer")
      .source("none by default");
  list.string("encoding", o.encoding,
              "Encoding of strings in the vector file that are not UTF-8, as ISO-8859-1; empty for what the file says.")
      .alias("encoding")
      .source("none by default");
  list.string(
          "where", o.where,
          "Filter that footprints must pass to be written, as in SQL after WHERE; those around them are still known.")
      .alias("where")
      .source("none by default");
  list.numbers("bbox", o.bbox, "m", {-far, far},
               "Box xmin ymin xmax ymax in the working CRS that footprints must meet to be written; those around it "
               "are still known; "
               "four zeros for all.")
      .alias("bbox")
      .source("none by default");
  list.number("tile_error", o.tile_error, "m", {0, far},
              "Geometric error from which tiles of a 3D Tiles tileset are taken; 0 for the finest.")
      .source("the finest tiles by default");
  list.string("terrain", o.terrain, "Raster with the ground's heights; empty to find the ground in the mesh.")
      .alias("dtm")
      .source("none by default")
      .number("cells_from", o.cells_from, "MB", {0, 1e9},
              "Size of the mesh files from which on the mesh is cut into cells on disk, so that memory does not grow "
              "with it.")
      .advanced("half a gigabyte of mesh files takes about 1 GB of memory; docs/city.md")
      .number("cell_side", o.cell_side, "m", {1, 10000}, "Side length of those cells.")
      .advanced("about the size of a block; not measured")
      .number("task_triangles", o.task_triangles, "", {1, 1e9},
              "Number of triangles of the mesh that are in memory at a time, where it is cut into cells; blocks larger "
              "than "
              "that are processed alone.")
      .advanced("about 200 MB with all that is made of them; docs/city.md")
      .number("task_footprints", o.task_footprints, "", {1, 1e9},
              "Number of footprints that are extruded at a time, where there is no mesh; blocks of more than that are "
              "processed alone.")
      .advanced("about 13 kB a footprint with all that is made of it; docs/city.md");
  return list;
}

auto is_read_y_up(const Options& options, const std::vector<model::InputFile>& inputs) -> bool {
  if (options.up != formats::UpAxis::automatic) return options.up == formats::UpAxis::y;
  constexpr std::array usually{".glb", ".gltf", ".b3dm", ".dae", ".fbx"};
  return std::ranges::any_of(inputs, [&](const auto& input) {
    return std::ranges::find(usually, formats::extension_of(input.path)) != usually.end() ||
           std::filesystem::path(input.path).filename() == "tileset.json";
  });
}

auto box_of(const Options& options) -> base::Result<std::optional<Box2>> {
  const auto& b = options.bbox;
  if (std::ranges::all_of(b, [](double c) { return c == 0; })) return std::optional<Box2>();
  if (!(b[0] < b[2] && b[1] < b[3]))
    return base::error("ingest-bbox", "the box has no inside; write xmin ymin xmax ymax", "ingest.bbox");
  return std::optional<Box2>(Box2{{b[0], b[1]}, {b[2], b[3]}});
}

auto read_scene(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& footprints,
                const Options& options, const base::Run& run) -> base::Result<model::Scene> {
  return guarded(meshes, footprints, [&] { return read(meshes, footprints, options, run); });
}

auto read_footprints(const std::filesystem::path& footprints, const Options& options, const base::Run& run)
    -> base::Result<model::Scene> {
  try {
    return read_alone(footprints, options, run);
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "the footprints do not fit into memory; read a part with --bbox or --where",
                       formats::shown_name(footprints));
  } catch (const std::exception& e) {
    return base::error("ingest-footprints-format", std::string("cannot be read (") + e.what() + "); check what it is",
                       formats::shown_name(footprints));
  }
}

}  // namespace mansard::ingest
