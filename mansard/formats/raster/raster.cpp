#include "mansard/formats/raster/raster.hpp"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <algorithm>
#include <cmath>
#include <memory>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Box2;
using geometry::Point2;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

auto bad(const std::string& what, const fs::path& path) -> base::Diagnostic {
  return base::error("ingest-raster", what, path.string());
}

/// From cells to the raster's coordinates and back: whole numbers are the cells' centres.
struct Affine {
  Point2 origin, column, row;  ///< centre of cell (0, 0); steps to the next column and the next row

  [[nodiscard]] auto place(Point2 cell) const -> Point2 { return origin + cell.x * column + cell.y * row; }
  [[nodiscard]] auto cell(Point2 place) const -> Point2 {
    const Point2 p = place - origin;
    return {cross(p, row) / cross(column, row), cross(column, p) / cross(column, row)};
  }
};

/// A piece of a raster's heights, row by row from its first, in metres; NaN for none.
struct Window {
  int left = 0, top = 0, columns = 0, rows = 0;
};

class RasterFile {
 public:
  static auto open(const fs::path& path) -> base::Result<RasterFile>;

  [[nodiscard]] auto affine() const -> const Affine& { return affine_; }
  [[nodiscard]] auto crs() const -> const OGRSpatialReference* { return crs_.get(); }
  [[nodiscard]] auto columns() const -> int { return band_->GetXSize(); }
  [[nodiscard]] auto rows() const -> int { return band_->GetYSize(); }
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }

  /// The cells whose centres lie in a box of the raster's coordinates, and one around them.
  [[nodiscard]] auto window(const Box2& box) const -> Window {
    Box2 cells;
    for (const Point2 p : {box.least, box.most, {box.least.x, box.most.y}, {box.most.x, box.least.y}})
      cells.add(affine_.cell(p));
    return window_of_cells(cells);
  }
  [[nodiscard]] auto window_of_cells(const Box2& cells) const -> Window {
    const auto inside = [](double c, int count) { return static_cast<int>(std::clamp(c, 0.0, double(count))); };
    Window out;
    out.left = inside(std::floor(cells.least.x), columns());
    out.top = inside(std::floor(cells.least.y), rows());
    out.columns = inside(std::ceil(cells.most.x) + 1, columns()) - out.left;
    out.rows = inside(std::ceil(cells.most.y) + 1, rows()) - out.top;
    return out;
  }
  [[nodiscard]] auto everything() const -> Window { return {0, 0, columns(), rows()}; }

  /// Rows `first` to `first + count` of a window.
  [[nodiscard]] auto read(const Window& window, int first, int count, std::vector<double>& heights)
      -> base::Result<void>;

 private:
  [[nodiscard]] auto understand() -> base::Result<void>;
  [[nodiscard]] auto to_metres() const -> base::Result<double>;

  fs::path path_;
  GDALDatasetUniquePtr dataset_;
  GDALRasterBand* band_ = nullptr;
  std::unique_ptr<OGRSpatialReference> crs_;
  Affine affine_;
  double scale_ = 1, offset_ = 0;
  std::vector<std::uint8_t> mask_;
  std::vector<base::Diagnostic> warnings_;
};

auto RasterFile::open(const fs::path& path) -> base::Result<RasterFile> {
  crs::register_gdal();
  if (!is_there(path)) return why_missing(path);
  if (auto checked = base::check_no_pipe(path); !checked) return checked.failure();
  const crs::GdalMessages messages;
  const Confined confined(path);
  RasterFile out;
  out.path_ = path;
  out.dataset_.reset(GDALDataset::Open(name_for_gdal(path).c_str(),
                                       GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr,
                                       nullptr));
  if (auto done = confined.check(); !done) return done.error();
  if (!out.dataset_ || out.dataset_->GetRasterCount() == 0)
    return bad("not a raster that GDAL reads" + (messages.failure().empty() ? "" : " (" + messages.failure() + ")") +
                   "; give heights as GeoTIFF, VRT, ASCII grid or IMG",
               path);
  if (!is_virtual(path)) {
    const CPLStringList files(out.dataset_->GetFileList());
    for (int i = 0; i < files.Count(); ++i)
      if (auto reach = check_reach(path, files[i]); !reach) return reach.error();
  }
  if (auto done = out.understand(); !done) return done.error();
  return out;
}

auto RasterFile::understand() -> base::Result<void> {
  band_ = dataset_->GetRasterBand(1);
  const int bands = dataset_->GetRasterCount();
  const auto colour = band_->GetColorInterpretation();
  if (bands >= 3 && (colour == GCI_RedBand || band_->GetRasterDataType() == GDT_Byte))
    return bad("it is a picture of " + std::to_string(bands) + " bands, not heights; give a surface or terrain model",
               path_);
  if (GDALDataTypeIsComplex(band_->GetRasterDataType()) != 0)
    return bad("its numbers are complex, so they are no heights; give a surface or terrain model", path_);
  if (bands > 1)
    warnings_.push_back(base::warning("ingest-raster-bands",
                                      "it has " + std::to_string(bands) + " bands; heights are read from the first",
                                      path_.string()));
  double g[6];
  if (dataset_->GetGeoTransform(g) != CE_None)
    return bad("it does not say where it lies; give it a geotransform, as gdal_translate -a_ullr does", path_);
  affine_ = {{g[0] + (g[1] + g[2]) / 2, g[3] + (g[4] + g[5]) / 2}, {g[1], g[4]}, {g[2], g[5]}};
  if (!(std::abs(cross(affine_.column, affine_.row)) > 0))
    return bad("its cells have no area; correct its geotransform", path_);
  if (const OGRSpatialReference* crs = dataset_->GetSpatialRef(); crs != nullptr && !crs->IsLocal()) {
    crs_ = std::make_unique<OGRSpatialReference>(*crs);
    crs_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }
  const auto unit = to_metres();
  if (!unit) return unit.error();
  if (crs_ && crs_->IsCompound() != 0) crs_->StripVertical();
  if (crs_) crs_->DemoteTo2D(nullptr);
  int is_set = 0;
  const double scale = band_->GetScale(&is_set);
  scale_ = (is_set != 0 ? scale : 1) * *unit;
  const double offset = band_->GetOffset(&is_set);
  offset_ = (is_set != 0 ? offset : 0) * *unit;
  return {};
}

/// Metres a unit of height, by the band or else by the vertical part of the CRS.
auto RasterFile::to_metres() const -> base::Result<double> {
  const std::string unit = base::lower(band_->GetUnitType());
  if (unit.empty() && crs_ && crs_->IsVertical() != 0) return crs_->GetTargetLinearUnits("VERT_CS");
  if (unit.empty() || unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters")
    return 1.0;
  if (unit == "ft" || unit == "foot" || unit == "feet" || unit == "international foot") return 0.3048;
  if (unit == "us survey foot" || unit == "us-ft" || unit == "ftus" || unit == "us feet" || unit == "us survey feet")
    return 1200.0 / 3937;
  if (unit == "cm" || unit == "centimetre" || unit == "centimeter") return 0.01;
  return bad("its heights are in '" + base::on_one_line(unit) + "'; give them in metres or feet", path_);
}

auto RasterFile::read(const Window& window, int first, int count, std::vector<double>& heights) -> base::Result<void> {
  const Confined confined(path_);  // sources of a VRT are opened when they are read
  const crs::GdalMessages messages;
  const std::size_t cells = static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(count);
  heights.resize(cells);
  mask_.resize(cells);
  const int top = window.top + first;
  if (band_->RasterIO(GF_Read, window.left, top, window.columns, count, heights.data(), window.columns, count,
                      GDT_Float64, 0, 0, nullptr) != CE_None ||
      band_->GetMaskBand()->RasterIO(GF_Read, window.left, top, window.columns, count, mask_.data(), window.columns,
                                     count, GDT_Byte, 0, 0, nullptr) != CE_None) {
    if (auto done = confined.check(); !done) return done;
    return bad("it cannot be read to its end (" + messages.failure() + "); copy or make it again", path_);
  }
  if (auto done = confined.check(); !done) return done;
  // Deeper than any land and higher than any city: a mark for "none" that the raster does not declare.
  constexpr double lowest = -1000, highest = 10000;
  for (std::size_t i = 0; i < cells; ++i) {
    double& z = heights[i];
    z = mask_[i] == 0 ? std::numeric_limits<double>::quiet_NaN() : z * scale_ + offset_;
    if (!(z >= lowest && z <= highest)) z = std::numeric_limits<double>::quiet_NaN();
  }
  return {};
}

/// Vertices and triangles, a row of cells at a time.
class Weaver {
 public:
  Weaver(const RasterFile& raster, const Window& window, RawMesh& mesh)
      : raster_(raster),
        window_(window),
        mesh_(mesh),
        mirrored_(cross(raster.affine().column, raster.affine().row) > 0),
        above_(static_cast<std::size_t>(window.columns), no_vertex),
        below_(above_) {}

  void add_row(int row, const double* heights) {
    std::swap(above_, below_);
    for (std::size_t c = 0; c < below_.size(); ++c) {
      below_[c] = no_vertex;
      if (std::isnan(heights[c])) continue;
      const Point2 at = raster_.affine().place({static_cast<double>(c) + window_.left, double(row) + window_.top});
      below_[c] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back({at.x, at.y, heights[c]});
    }
    if (row == 0) return;
    for (std::size_t c = 0; c + 1 < below_.size(); ++c) add_cell(above_[c], above_[c + 1], below_[c], below_[c + 1]);
  }

 private:
  [[nodiscard]] auto rise(std::uint32_t a, std::uint32_t b) const -> double {
    return std::abs(mesh_.vertices[a].z - mesh_.vertices[b].z);
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mirrored_) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }
  void add_cell(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    if (a == no_vertex || b == no_vertex || c == no_vertex || d == no_vertex) return;
    // Along an edge of a roof the two ends of the flatter diagonal lie on the same side of it.
    if (rise(a, d) <= rise(b, c)) {
      add(a, c, d);
      add(a, d, b);
    } else {
      add(a, c, b);
      add(b, c, d);
    }
  }

  const RasterFile& raster_;
  const Window& window_;
  RawMesh& mesh_;
  bool mirrored_;  // rows run from south to north
  std::vector<std::uint32_t> above_, below_;
};

auto wkt_of(const OGRSpatialReference* crs) -> std::string {
  if (crs == nullptr) return {};
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  const OGRErr failed = crs->exportToWkt(&text, options);
  std::string wkt = failed == OGRERR_NONE && text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

/// From the frame's CRS to a raster's cells and back. Where one of the two has no CRS they are taken to be the same.
class Path {
 public:
  static auto between(const model::Frame& frame, const RasterFile& raster, const fs::path& path) -> base::Result<Path> {
    Path out(frame, raster);
    if (frame.crs.empty() || raster.crs() == nullptr) return out;
    const crs::GdalMessages messages;
    OGRSpatialReference own;
    own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const bool known = own.SetFromUserInput(frame.crs.c_str(),
                                            OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) == OGRERR_NONE;
    if (known && own.IsSame(raster.crs()) != 0) return out;
    if (known) {
      out.there_.reset(OGRCreateCoordinateTransformation(&own, raster.crs()));
      out.back_.reset(OGRCreateCoordinateTransformation(raster.crs(), &own));
    }
    if (!out.there_ || !out.back_)
      return bad("there is no way from the CRS of the raster to " + frame.crs.substr(0, frame.crs.find('[')) + " (" +
                     messages.failure() + "); project it with gdalwarp",
                 path);
    return out;
  }

  [[nodiscard]] auto is_straight() const -> bool { return !there_; }
  /// The cells at points of the local frame; NaN where there is no way.
  void to_cells(std::vector<Point2>& points) const {
    for (auto& p : points) p = p + origin_;
    go(there_.get(), points);
    for (auto& p : points) p = affine_.cell(p);
  }
  void to_frame(std::vector<Point2>& cells) const {
    for (auto& p : cells) p = affine_.place(p);
    go(back_.get(), cells);
    for (auto& p : cells) p = p - origin_;
  }

 private:
  Path(const model::Frame& frame, const RasterFile& raster)
      : origin_{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])}, affine_(raster.affine()) {}

  static void go(OGRCoordinateTransformation* way, std::vector<Point2>& points) {
    if (way == nullptr) return;
    const crs::GdalMessages messages;
    std::vector<double> x, y;
    for (const auto p : points) {
      x.push_back(p.x);
      y.push_back(p.y);
    }
    std::vector<int> done(points.size(), 0);
    way->Transform(static_cast<int>(points.size()), x.data(), y.data(), nullptr, nullptr, done.data());
    constexpr double lost = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = done[i] != 0 ? Point2{x[i], y[i]} : Point2{lost, lost};
  }

  Point2 origin_;
  Affine affine_;
  std::unique_ptr<OGRCoordinateTransformation> there_, back_;
};

/// Points along the edge of a box, for where its image under a projection lies.
auto edge_of(const Box2& box) -> std::vector<Point2> {
  constexpr int steps = 20;
  const Point2 size = box.most - box.least;
  std::vector<Point2> out;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    for (const Point2 share : {Point2{t, 0}, {t, 1}, {0, t}, {1, t}})
      out.push_back(box.least + Point2{share.x * size.x, share.y * size.y});
  }
  return out;
}

auto finite_box_of(const std::vector<Point2>& points) -> Box2 {
  Box2 box;
  for (const auto p : points)
    if (std::isfinite(p.x) && std::isfinite(p.y)) box.add(p);
  return box;
}

auto in_words(const Box2& box, Point2 origin) -> std::string {
  return "x " + base::to_text(box.least.x + origin.x, 1) + " to " + base::to_text(box.most.x + origin.x, 1) + ", y " +
         base::to_text(box.least.y + origin.y, 1) + " to " + base::to_text(box.most.y + origin.y, 1);
}

/// How long the side of a cell is in the frame, around a point of it.
auto cell_size(const Path& path, Point2 at) -> double {
  std::vector<Point2> around{at, at + Point2{1, 0}, at + Point2{0, 1}};
  path.to_cells(around);
  return 1 / std::sqrt(std::abs(cross(around[1] - around[0], around[2] - around[0])));
}

/// An empty grid whose centres cover the box: the raster's own centres where they can be kept.
auto lay_out(const Path& path, const Affine& affine, Box2 box) -> model::HeightGrid {
  model::HeightGrid grid;
  const double width = affine.column.x, height = affine.row.y;
  const bool kept = path.is_straight() && affine.column.y == 0 && affine.row.x == 0 &&
                    std::abs(std::abs(width) - std::abs(height)) <= 1e-9 * std::abs(width);
  grid.cell = kept ? std::abs(width) : cell_size(path, 0.5 * (box.least + box.most));
  constexpr double most_cells = 1e8;
  const Point2 size = box.most - box.least;
  bool coarser = false;
  while (size.x / grid.cell * (size.y / grid.cell) > most_cells) {
    grid.cell *= 2;
    coarser = true;
  }
  grid.centre = box.least;
  if (kept && !coarser) {
    std::vector<Point2> corners{{0, 0}};
    path.to_frame(corners);
    const auto down = [&](double from, double first) {
      return first + std::floor((from - first) / grid.cell) * grid.cell;
    };
    grid.centre = {down(box.least.x, corners[0].x), down(box.least.y, corners[0].y)};
  }
  grid.columns = static_cast<std::size_t>(std::ceil((box.most.x - grid.centre.x) / grid.cell - 1e-6)) + 1;
  grid.rows = static_cast<std::size_t>(std::ceil((box.most.y - grid.centre.y) / grid.cell - 1e-6)) + 1;
  grid.values.assign(grid.columns * grid.rows, none);
  return grid;
}

/// Between the four nearest centres; none where one that counts has no height.
auto between(const std::vector<float>& heights, const Window& window, Point2 cell) -> double {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  constexpr double same = 1e-6;  // of a cell: a rounding of coordinates, not a place between two centres
  double x = cell.x - window.left, y = cell.y - window.top;
  if (std::abs(x - std::round(x)) < same) x = std::round(x);
  if (std::abs(y - std::round(y)) < same) y = std::round(y);
  if (!(x >= 0 && y >= 0 && x <= window.columns - 1 && y <= window.rows - 1)) return nowhere;
  const auto c = static_cast<std::size_t>(x), r = static_cast<std::size_t>(y);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  const auto columns = static_cast<std::size_t>(window.columns);
  double z = 0;
  for (const auto& [dc, dr, weight] :
       {std::tuple{0U, 0U, (1 - u) * (1 - v)}, {1U, 0U, u * (1 - v)}, {0U, 1U, (1 - u) * v}, {1U, 1U, u * v}})
    if (weight > 0) z += weight * static_cast<double>(heights[(r + dr) * columns + c + dc]);
  return z;
}

}  // namespace

auto is_raster(const fs::path& path) -> bool { return has_extension(path, &Reads::raster); }

auto read_raster(const fs::path& path, const std::optional<Box2>& within) -> base::Result<RasterMesh> {
  auto raster = RasterFile::open(path);
  if (!raster) return raster.error();
  RasterMesh out;
  out.crs = wkt_of(raster->crs());
  out.warnings = raster->warnings();
  const Window window = within ? raster->window(*within) : raster->everything();
  if (window.columns <= 0 || window.rows <= 0) return out;
  if (static_cast<double>(window.columns) * window.rows >= static_cast<double>(no_vertex))
    return bad("it has more than 4 thousand million cells; read a part with --bbox, or make it coarser", path);
  Weaver weaver(*raster, window, out.mesh);
  // So many rows at a time that GDAL need not fetch a block of the file twice.
  constexpr int strip = 256;
  std::vector<double> heights;
  for (int first = 0; first < window.rows; first += strip) {
    const int count = std::min(strip, window.rows - first);
    if (auto done = raster->read(window, first, count, heights); !done) return done.error();
    for (int r = 0; r < count; ++r)
      weaver.add_row(first + r, heights.data() + static_cast<std::ptrdiff_t>(r) * window.columns);
  }
  if (!within && out.mesh.vertices.empty()) return bad("none of its cells has a height; check its nodata value", path);
  return out;
}

auto read_terrain(const fs::path& path, const model::Frame& frame, const Box2& within)
    -> base::Result<model::HeightGrid> {
  auto raster = RasterFile::open(path);
  if (!raster) return raster.error();
  const auto way = Path::between(frame, *raster, path);
  if (!way) return way.error();
  auto own_edge = edge_of({{0, 0}, {raster->columns() - 1.0, raster->rows() - 1.0}});
  way->to_frame(own_edge);
  const Box2 covered = finite_box_of(own_edge);
  const Point2 origin{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])};
  const Box2 box{{std::max(covered.least.x, within.least.x), std::max(covered.least.y, within.least.y)},
                 {std::min(covered.most.x, within.most.x), std::min(covered.most.y, within.most.y)}};
  const auto beside = [&] {
    return bad("it covers nothing of what is read: it lies in " + in_words(covered, origin) + ", the rest in " +
                   in_words(within, origin) + "; check its CRS, and --crs",
               path);
  };
  if (!(box.least.x <= box.most.x && box.least.y <= box.most.y)) return beside();

  model::HeightGrid grid = lay_out(*way, raster->affine(), box);
  grid.base = static_cast<double>(frame.origin[2]);
  auto cells =
      edge_of({grid.centre, grid.centre + grid.cell * Point2{double(grid.columns - 1), double(grid.rows - 1)}});
  way->to_cells(cells);
  // Curved edges may reach a little farther than the points on them.
  const Window window = raster->window_of_cells(finite_box_of(cells).grown(2));
  if (window.columns <= 0 || window.rows <= 0) return beside();
  std::vector<double> read;
  std::vector<float> heights;
  constexpr int strip = 256;
  for (int first = 0; first < window.rows; first += strip) {
    if (auto done = raster->read(window, first, std::min(strip, window.rows - first), read); !done) return done.error();
    for (const double z : read) heights.push_back(static_cast<float>(z));
  }
  bool any = false;
  std::vector<Point2> line(grid.columns);
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::size_t c = 0; c < grid.columns; ++c)
      line[c] = grid.centre + grid.cell * Point2{static_cast<double>(c), static_cast<double>(r)};
    way->to_cells(line);
    for (std::size_t c = 0; c < grid.columns; ++c) {
      const double z = between(heights, window, line[c]);
      any = any || !std::isnan(z);
      grid.values[r * grid.columns + c] = static_cast<float>(z);
    }
  }
  if (!any) return bad("it has no heights where the rest lies; check its nodata value", path);
  return grid;
}

}  // namespace mansard::formats
