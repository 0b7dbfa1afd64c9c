#include "mansard/ingest/detail/mesh_files.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/context_capture/context_capture.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/formats/mesh/append.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/mesh/mesh_stream.hpp"
#include "mansard/formats/osgb/osgb_file.hpp"
#include "mansard/formats/raster/raster.hpp"
#include "mansard/ingest/detail/clean.hpp"
#include "mansard/ingest/detail/cloud_pieces.hpp"
#include "mansard/ingest/detail/files_below.hpp"

namespace mansard::ingest::detail {
namespace {

namespace fs = std::filesystem;
using geometry::Box2;
using geometry::Point2;
using geometry::Point3;

constexpr const char *tileset_name = "tileset.json", *ept_name = "ept.json";

/// Archives are folders; the file extension .3tz is that of a zipped tileset.
auto unpacked_name(const fs::path& path) -> fs::path {
  if (formats::is_virtual(path)) return path;
  const std::string extension = formats::extension_of(path);
  if (extension == ".3tz") return "/vsizip/{" + path.string() + "}";
  return extension == ".zip" ? fs::path("/vsizip/" + path.string()) : path;
}

auto is_folder(const fs::path& path) -> bool {
  if (!formats::is_virtual(path)) {
    std::error_code failure;
    return fs::is_directory(path, failure);
  }
  const crs::GdalMessages messages;
  VSIStatBufL found{};
  return VSIStatL(path.string().c_str(), &found) == 0 && VSI_ISDIR(found.st_mode);
}

/// Whether the name is that of an archive as such, not of a member, and it can be looked into.
auto is_whole_archive(const fs::path& path) -> bool {
  if (!path.string().starts_with("/vsizip/")) return false;
  const auto [archive, member] = formats::archive_of(path.string());
  if (archive.empty() || !member.empty()) return false;
  const auto members = files_below(path);
  return members && !members->empty();
}

auto is_below(const fs::path& file, const std::vector<std::string>& folders) -> bool {
  const std::string name = file.string();  // generic_string() would make "/vsizip//tmp" another name
  return std::ranges::any_of(folders, [&](const std::string& folder) { return name.starts_with(folder); });
}

/// Where a raster is: its CRS, and its box in that.
struct RasterPlace {
  std::optional<crs::MeshCrs> crs;
  Box2 plan;
};
auto place_of_raster(const fs::path& path) -> RasterPlace {
  const crs::GdalMessages messages;
  crs::register_gdal();
  const formats::Confined confined(path);
  GDALDatasetH data =
      GDALOpenEx(formats::name_for_gdal(path).c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr);
  RasterPlace place;
  if (data == nullptr) return place;  // why, reading it says
  const auto* system = OGRSpatialReference::FromHandle(GDALGetSpatialRef(data));
  if (system != nullptr && (system->IsProjected() != 0 || system->IsGeographic() != 0)) {
    place.crs.emplace();
    place.crs->wkt = crs::wkt_of(crs::flat(*system).system);
  }
  if (std::array<double, 6> to{}; GDALGetGeoTransform(data, to.data()) == CE_None)
    for (const int column : {0, GDALGetRasterXSize(data)})
      for (const int row : {0, GDALGetRasterYSize(data)})
        place.plan.add({to[0] + to[1] * column + to[2] * row, to[3] + to[4] * column + to[5] * row});
  GDALClose(data);
  return place;
}

void warn_of_skipped(const std::map<std::string, std::size_t>& skipped, const std::string& subject,
                     std::vector<base::Diagnostic>& warnings) {
  for (const auto& [kind, count] : skipped)
    warnings.push_back(base::warning(
        "ingest-tile-skipped",
        std::to_string(count) + " tiles hold " + kind + ", of which no surface is read (points, instances or vectors)",
        subject));
}

}  // namespace

auto MeshReading::list_folder(const fs::path& folder) -> base::Result<void> {
  const auto below = files_below(folder);
  if (!below) return below.error();
  // What is in the folder of a tileset belongs to it, and is placed by it only.
  std::vector<std::string> tilesets;
  std::vector<fs::path> found;
  std::map<std::string, const char*> index;
  for (const auto& path : *below)
    for (const char* name : {tileset_name, ept_name})
      if (path.filename() == name && index.emplace(path.parent_path().string() + "/", name).second)
        tilesets.push_back(path.parent_path().string() + "/");
  std::ranges::sort(tilesets);
  for (std::size_t i = 0; i < tilesets.size(); ++i) {
    const std::vector<std::string> before(tilesets.begin(), tilesets.begin() + static_cast<std::ptrdiff_t>(i));
    if (!is_below(tilesets[i], before)) found.emplace_back(tilesets[i] + index.at(tilesets[i]));
  }
  const std::set<fs::path> all(below->begin(), below->end());
  // A tile of OSGB leads to its levels.
  const auto is_level = [&](const fs::path& path) {
    return formats::extension_of(path) == ".osgb" && all.contains(formats::tile_of_level(path));
  };
  for (const auto& path : *below)
    if (formats::is_mesh_name(path) && !is_below(path, tilesets) && !is_level(path)) found.push_back(path);
  if (found.empty())
    return base::error("ingest-mesh-empty",
                       "the folder holds no meshes; expected a tileset.json, or files with the extension " +
                           formats::extensions_in_words(&formats::Reads::mesh),
                       folder.string());
  std::ranges::sort(found, {}, [](const fs::path& path) { return path.generic_string(); });
  for (auto& path : found) {
    auto& source = sources_.emplace_back();
    source.kind = path.filename() == tileset_name ? Kind::tileset
                  : formats::is_point_cloud(path) ? Kind::cloud
                                                  : Kind::file;
    source.path = std::move(path);
  }
  return {};
}

auto MeshReading::list(const std::vector<fs::path>& paths) -> base::Result<void> {
  for (const auto& given : paths) {
    if (auto piped = base::check_no_pipe(given); !piped) return piped;
    const fs::path path = unpacked_name(given);
    // An archive of a single file is that file to GDAL, whatever its name.
    if (is_folder(path) || is_whole_archive(path)) {
      if (auto done = list_folder(path); !done) return done;
      continue;
    }
    auto& source = sources_.emplace_back();
    source.path = path;
    const auto extension = formats::extension_of(path);
    if (formats::is_point_cloud(path)) source.kind = Kind::cloud;
    else if (extension.starts_with(".json")) source.kind = Kind::tileset;  // maybe with a server's "?key=…"
    else if (formats::is_raster(path)) source.kind = Kind::raster;
  }
  if (sources_.empty()) return base::error("ingest-mesh-empty", "no mesh was given; name one file or folder at least");
  return {};
}

auto MeshReading::moved_by_option() const -> bool {
  return options_.mesh_offset[0] != 0 || options_.mesh_offset[1] != 0;
}

auto MeshReading::find_places(const base::Run& run) -> base::Result<void> {
  std::map<fs::path, std::optional<formats::Georeference>> known;
  for (auto& source : sources_) {
    if (source.kind == Kind::raster) {
      auto place = place_of_raster(source.path);
      source.crs = std::move(place.crs);
      source.plan = place.plan;
      continue;
    }
    if (source.kind == Kind::tileset) {
      auto tileset = formats::Tileset::open(source.path);
      if (!tileset) return tileset.error();
      source.tileset = std::move(*tileset);
      if (source.tileset->is_geocentric()) {
        source.crs.emplace().kind = crs::MeshCrs::Kind::geocentric;
        continue;
      }
    }
    if (source.kind == Kind::cloud) {
      auto cloud = formats::open_points(source.path);
      if (!cloud) return cloud.failure();
      source.cloud = std::move(*cloud);
      const auto& info = source.cloud->info();
      source.crs = info.crs;
      if (!info.crs) {
        if (info.stated_bounds) source.plan = info.stated_bounds->plan();
        // Where it is decides whether footprints without a CRS are in its frame, so a header without a box is no
        // answer.
        if (!(source.plan.least.x < source.plan.most.x && source.plan.least.y < source.plan.most.y)) {
          const auto box = measured_plan(*source.cloud, run);
          if (!box) return box.failure();
          source.plan = *box;
        }
      }
      warnings_.insert(warnings_.end(), info.warnings.begin(), info.warnings.end());
      if (source.crs) continue;
    }
    // Whoever moves the mesh in plan says where it is, and so does whoever says that it is nowhere.
    if (moved_by_option() || options_.crs == "local") continue;
    const fs::path folder = source.path.parent_path();
    auto found = known.find(folder);
    if (found == known.end()) {
      auto read = formats::georeference_of(folder.empty() ? fs::path(".") : folder);
      if (!read) return read.error();
      found = known.emplace(folder, std::move(*read)).first;
      if (const auto& place = found->second) metadata_.emplace(place->input.path, place->input);
    }
    const auto& place = found->second;
    if (!place) continue;
    source.crs = place->crs;
    source.by_metadata = true;
  }
  return {};
}

auto MeshReading::open(const std::vector<fs::path>& paths, const Options& options, const base::Run& run,
                       MeshCells* cells) -> base::Result<MeshReading> {
  MeshReading reading(options, cells);
  if (auto done = reading.list(paths); !done) return done.error();
  if (auto done = reading.find_places(run); !done) return done.error();
  auto& sources = reading.sources_;
  base::parallel_for(sources.size(), [&](std::size_t i) {
    if (sources[i].kind != Kind::file || run.cancelled()) return;
    Source& source = sources[i];
    if (cells != nullptr) {
      auto done = reading.streamed(source, run);
      if (!done) source.piece.failure = done.error();
      if (!done || *done) return;
    }
    source.piece = formats::read_mesh_file(source.path, options.up);
    source.plan = bounds(source.piece.mesh, {0, 0, 0}).plan();
    if (cells == nullptr) return;
    source.in_cells = !source.crs;  // else it is read again, when it is known where it goes
    if (source.in_cells) reading.into_cells(source.piece);
    else source.piece.mesh = {};
  });
  if (run.cancelled()) return base::stopped();
  for (const auto& source : sources)
    if (source.piece.failure) return *source.piece.failure;
  return reading;
}

/// A file that can be read piece by piece is put aside, and then goes to the cells or waits until it is known where to.
/// False where it must be read as a whole.
auto MeshReading::streamed(Source& source, const base::Run& run) -> base::Result<bool> {
  auto spooled = SpooledMesh::open();
  if (!spooled) return spooled.failure();
  auto& mesh = **spooled;
  auto piece = formats::stream_mesh_file(
      source.path, options_.up, [&](const formats::RawMesh& some) { mesh.add(some); }, run);
  if (!piece) return false;
  source.piece = std::move(*piece);
  if (source.piece.failure || run.cancelled()) return true;
  source.in_cells = !source.crs;
  if (auto done = into_cells(mesh, source, run); !done) return done.failure();
  if (!source.in_cells) source.spooled = std::move(*spooled);
  return true;
}

/// Where the mesh is; and the mesh to the cells, once it is known where to.
auto MeshReading::into_cells(SpooledMesh& mesh, Source& source, const base::Run& run) -> base::Result<void> {
  std::mutex mutex;
  const bool settled = source.in_cells || source.way;
  auto done = mesh.each(run, [&](formats::RawMesh piece) {
    const auto box = bounds(piece, {0, 0, 0}).plan();
    if (source.way) source.way->take(piece.vertices);
    if (settled) cells_->add(piece);
    const std::scoped_lock lock(mutex);
    if (!source.way) source.plan.include(box);
  });
  if (!done) return done;
  if (settled) {
    formats::RawMesh rest;  // what belongs to no piece
    rest.short_faces = mesh.short_faces();
    cells_->add(rest);
  }
  return {};
}

auto MeshReading::plan() const -> Box2 {
  Box2 out;
  const Point2 offset{options_.mesh_offset[0], options_.mesh_offset[1]};
  for (const auto& source : sources_) {
    Box2 box;
    const bool placed_by_itself = source.kind == Kind::raster && source.crs;
    if (source.kind != Kind::tileset && !placed_by_itself) box = source.plan;
    if (source.tileset) box = source.tileset->plan();
    if (box.empty()) continue;
    out.add(box.least + offset);
    out.add(box.most + offset);
  }
  return out;
}

/// Leaves of the mesh how much it was.
void MeshReading::into_cells(formats::MeshPiece& piece) {
  cells_->add(piece.mesh);
  piece.vertices = piece.mesh.vertices.size();
  piece.triangles = piece.mesh.triangles.size();
  piece.mesh = {};
}

/// A point of the mesh, as its file has it.
auto MeshReading::place_of(const Source& source) const -> std::optional<Point3> {
  if (source.tileset) return source.tileset->middle();
  if (source.cloud)
    if (const auto& box = source.cloud->info().stated_bounds) return 0.5 * (box->least + box->most);
  if (source.kind == Kind::file) return Point3{};  // beside the origin that metadata.xml says
  return std::nullopt;
}

auto MeshReading::own_crs() const -> std::string {
  const crs::GdalMessages messages;
  for (const auto& source : sources_) {
    if (!source.crs || source.crs->kind != crs::MeshCrs::Kind::plane) continue;
    const auto system = crs::from_wkt(source.crs->wkt);
    if (system && system->system.IsProjected() != 0 && crs::in_metres(system->system))
      return crs::name_of(system->system);
  }
  return {};
}

auto MeshReading::own_crs_or_zone() const -> std::string {
  auto own = own_crs();
  for (const auto& source : sources_) {
    if (!own.empty()) break;
    const auto place = place_of(source);
    if (const auto& crs = source.crs; place && crs) own = crs::working_crs_of(*crs, *place);
  }
  return own;
}

auto MeshReading::choose_ways(const std::string& working) -> base::Result<void> {
  for (auto& source : sources_) {
    // In a local frame a mesh keeps its own numbers, but for those that count from the middle of the earth.
    const bool on_earth = source.crs && source.crs->kind == crs::MeshCrs::Kind::geocentric && !source.by_metadata;
    if (!source.crs || (working.empty() && !on_earth)) continue;
    auto way = crs::WayOfMesh::between(*source.crs, working, source.path.string());
    if (!way) return way.error();
    source.way = std::move(*way);
  }
  return {};
}

auto MeshReading::list_tiles(const std::optional<Box2>& within, const base::Run& run) -> base::Result<void> {
  for (auto& source : sources_) {
    if (!source.tileset) continue;
    const bool on_earth = source.tileset->is_geocentric();
    const auto box = within && source.way && !on_earth ? source.way->back(*within) : within;
    const formats::TileFilter filter(box, on_earth && source.way ? &*source.way : nullptr);
    auto tiles = source.tileset->tiles(options_.tile_error, options_.up, filter, run);
    if (!tiles) return tiles.error();
    source.tiles = std::move(tiles->files);
    source.piece.inputs = std::move(tiles->inputs);
    tiles_beside_ += tiles->beside;
  }
  return {};
}

/// All pieces of a source, on their way to the working CRS.
auto MeshReading::read_placed(Source& source, const std::optional<Box2>& within, const base::Run& run)
    -> std::vector<formats::MeshPiece> {
  std::vector<formats::MeshPiece> pieces;
  if (source.kind == Kind::raster) {
    auto& piece = pieces.emplace_back();
    const auto box = within && source.way ? source.way->back(*within) : within;
    auto raster = formats::read_raster(source.path, box);
    if (!raster) return piece.failure = raster.error(), pieces;
    piece.mesh = std::move(raster->mesh);
    warnings_.insert(warnings_.end(), raster->warnings.begin(), raster->warnings.end());
    auto input = formats::input_file(source.path);
    if (input) piece.inputs.push_back(std::move(*input));
  } else if (source.spooled) {
    auto& piece = pieces.emplace_back(std::move(source.piece));
    source.in_cells = true;
    if (auto done = into_cells(*source.spooled, source, run); !done) piece.failure = done.error();
    source.spooled.reset();
    return pieces;
  } else if (cells_ != nullptr && source.kind == Kind::file && !source.in_cells) {
    pieces.push_back(formats::read_mesh_file(source.path, options_.up));
  } else {
    pieces.push_back(std::move(source.piece));
  }
  const std::size_t first = source.tileset ? 1 : 0;
  pieces.resize(pieces.size() + source.tiles.size());
  base::parallel_for(pieces.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    if (source.tileset && i >= first) pieces[i] = formats::read_tile_file(source.tiles[i - first]);
    if (source.way) source.way->take(pieces[i].mesh.vertices);
    if (cells_ != nullptr && !source.in_cells) into_cells(pieces[i]);
  });
  return pieces;
}

auto MeshReading::finish(const std::string& working, const std::optional<Box2>& within, const base::Run& run)
    -> base::Result<MeshFiles> {
  const std::string name = sources_.front().path.string();
  const std::string subject = sources_.size() == 1 ? name : name + " and others";
  std::optional<Box2> raw = within;
  if (raw) {
    const Point2 offset{options_.mesh_offset[0], options_.mesh_offset[1]};
    raw = Box2{raw->least - offset, raw->most - offset};
  }
  if (auto done = choose_ways(working); !done) return done.error();
  if (auto done = list_tiles(raw, run); !done) return done.error();

  std::vector<formats::MeshPiece> pieces;
  std::map<std::string, std::size_t> skipped;
  std::size_t vertices = 0, triangles = 0;
  MeshFiles out;
  auto surfaces = surface_of_clouds(raw, run, out);
  if (!surfaces) return surfaces.failure();
  for (auto& piece : *surfaces) {
    vertices += piece.mesh.vertices.size() + piece.vertices;
    triangles += piece.mesh.triangles.size() + piece.triangles;
    pieces.push_back(std::move(piece));
  }
  for (auto& source : sources_) {
    if (source.kind == Kind::cloud) continue;
    auto some = read_placed(source, raw, run);
    if (run.cancelled()) return base::stopped();
    for (auto& piece : some) {
      if (piece.failure) return *piece.failure;
      vertices += piece.mesh.vertices.size() + piece.vertices;
      triangles += piece.mesh.triangles.size() + piece.triangles;
      for (const auto& kind : piece.skipped) ++skipped[kind];
      warnings_.insert(warnings_.end(), piece.warnings.begin(), piece.warnings.end());
      if (source.kind == Kind::file && piece.mesh.triangles.empty() && piece.triangles == 0 && sources_.size() > 1)
        warnings_.push_back(base::warning("ingest-mesh-no-faces", "the file adds no faces", piece.inputs.front().path));
      pieces.push_back(std::move(piece));
    }
  }
  warn_of_skipped(skipped, subject, warnings_);
  if (cells_ == nullptr && vertices >= formats::no_vertex)
    return base::error("ingest-memory", "more than 4 thousand million vertices; reconstruct part after part", subject);
  if (triangles == 0 && tiles_beside_ > 0)
    return base::error("ingest-no-overlap",
                       "no tile of the tileset reaches into the box asked for; check --bbox, --crs and --mesh-offset",
                       subject);
  if (triangles == 0)
    return base::error(
        "ingest-mesh-unusable",
        "there are " + std::to_string(vertices) + " vertices but no faces; export the mesh with its faces", subject);
  if (pieces.size() > 1 && cells_ == nullptr) {
    out.mesh.vertices.reserve(vertices);
    out.mesh.triangles.reserve(triangles);
  }
  for (auto& piece : pieces) {
    append(out.mesh, std::move(piece.mesh));
    out.inputs.insert(out.inputs.end(), piece.inputs.begin(), piece.inputs.end());
    piece = {};
  }
  if (!working.empty())
    for (const auto& [folder, input] : metadata_) out.inputs.push_back(input);
  out.warnings = std::move(warnings_);
  out.vertices_read = vertices;
  return out;
}

}  // namespace mansard::ingest::detail
