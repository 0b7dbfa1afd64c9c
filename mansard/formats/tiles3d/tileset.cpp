#include "mansard/formats/tiles3d/tileset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>

#include "mansard/base/nesting.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/uri.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/tiles3d/tile_subtree.hpp"
#include "mansard/formats/tiles3d/tileset_json.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Point3;
using Json = nlohmann::ordered_json;

auto bad(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("ingest-mesh-format", what, name);
}

auto transform_of(const TileJson& tile, const std::string& name) -> base::Result<Transform> {
  const auto own = tile.transform();
  if (!own) return bad("the transform of a tile is not 16 numbers; export the tileset again", name);
  return *own;
}

/// glTF is y up by its standard; tilesets from before 3D Tiles 1.0 say what theirs is.
auto turn_of(const TilesetJson& tileset, UpAxis up) -> Transform {
  const auto axis = text_in(tileset.asset(), "gltfUpAxis");
  if (up == UpAxis::z || (up == UpAxis::automatic && (axis == "Z" || axis == "z"))) return {};
  if (up == UpAxis::automatic && (axis == "X" || axis == "x")) return {{{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}}}};
  return Transform::from_y_up();
}

auto parse_tileset(std::string_view bytes, const std::string& name) -> base::Result<TilesetJson> {
  TilesetJson tileset(bytes);
  if (tileset.fault() == TilesetJson::Fault::too_deep)
    return bad(
        "its JSON nests more than " + std::to_string(base::deepest_json) + " levels deep; export the tileset again",
        name);
  if (tileset.fault() != TilesetJson::Fault::none || tileset.asset().empty() ||
      object_in(tileset.json(), "root").empty())
    return bad("the file is no tileset of 3D Tiles: it has no asset and root; check what it is", name);
  if (const auto extension = tileset.unknown_extension())
    return bad("the tileset requires the extension " + *extension + ", which is not read; write it without", name);
  return tileset;
}

/// On the ellipsoid of WGS 84.
auto from_degrees(double longitude, double latitude, double height) -> Point3 {
  constexpr double major = 6378137, flattening = 1 / 298.257223563, squared = flattening * (2 - flattening);
  const double l = longitude * std::numbers::pi / 180, b = latitude * std::numbers::pi / 180;
  const double n = major / std::sqrt(1 - squared * std::sin(b) * std::sin(b));
  return {(n + height) * std::cos(b) * std::cos(l), (n + height) * std::cos(b) * std::sin(l),
          (n * (1 - squared) + height) * std::sin(b)};
}

auto moves_only(const Transform& t) -> bool {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (std::abs(t.row[i][j] - (i == j ? 1 : 0)) > 1e-9) return false;
  return true;
}

/// Near the ellipsoid, unless it may as well be metres of a plane with the same numbers: a northing of 6,360 km at 57°
/// north looks like a point of the equator. The middle of a large volume lies below the ground; one as large as a
/// continent is on the earth whatever its middle.
auto looks_geocentric(Point3 p, double reach, const Transform& root) -> bool {
  constexpr double strip = 10'000, continent = 2'000'000, radius = 6'356'752;  // m
  if (reach > continent) return true;
  return crs::near_ellipsoid(p, reach * reach / radius) && (std::abs(p.z) > strip || !moves_only(root));
}

/// Goes down the tree and keeps what is to be read.
class Walk {
 public:
  Walk(double error, UpAxis up, const TileFilter& filter, const base::Run& run)
      : error_(error), up_(up), filter_(filter), run_(run) {}

  auto take_root(const fs::path& path) -> base::Result<void> { return take_file(path, {}, nullptr, 0); }

  auto list() -> TileList { return std::move(list_); }

 private:
  /// The file that a tile is written in.
  struct Sheet {
    const fs::path& path;
    Transform turn;
    const Sheet* within;  ///< none for the first one
  };
  /// A tree that follows from its root.
  struct Implicit {
    Transform place;
    Volume volume;  ///< of the root, placed
    double error = 0;
    bool add = false, octree = false;
    std::uint32_t subtree_levels = 0, levels = 0;
    std::string subtrees;  ///< template
    std::vector<TileContentName> contents;
    int depth = 0;  ///< of the root
  };

  auto take_file(const fs::path& path, const Transform& outer, const Sheet* within, int depth) -> base::Result<void> {
    const std::string name = path.string();
    int files = 0;
    for (const Sheet* sheet = within; sheet != nullptr; sheet = sheet->within, ++files)
      if (sheet->path == path) return bad("the tileset is nested in itself; export it again", name);
    if (files > 64) return bad("tilesets are nested more than 64 deep, as if they held one another", name);
    if (run_.cancelled()) return base::stopped();
    const auto bytes = within == nullptr ? Bytes::of(path) : bytes_of_named(path);
    if (!bytes) return bytes.error();
    const auto tileset = parse_tileset(bytes->view(), name);
    if (!tileset) return tileset.error();
    list_.inputs.push_back({name, bytes->view().size(), sha256(bytes->view())});
    const Sheet sheet{path, turn_of(*tileset, up_), within};
    return take_tile(tileset->root(), sheet, outer, false, depth);
  }

  /// Tiles can name the same file again and again, and an implicit tiling all tiles of thirty levels in a few words:
  /// what follows from so little must not go on for ever.
  auto count_tile(const Sheet& sheet) -> base::Result<void> {
    constexpr std::size_t most = 1'000'000;
    if (++tiles_ <= most) return {};
    return bad("the tileset has more than a million tiles to look at; take fewer, with --bbox or --ingest-tile-error",
               sheet.path.string());
  }

  auto take_tile(const TileJson& tile, const Sheet& sheet, const Transform& outer, bool add, int depth)
      -> base::Result<void> {
    const std::string name = sheet.path.string();
    if (!tile.is_object()) return bad("a tile is not an object; export the tileset again", name);
    if (depth > 1000) return bad("the tree of tiles is more than 1000 deep; export the tileset again", name);
    const auto own = transform_of(tile, name);
    if (!own) return own.error();
    const Transform place = outer.after(*own);
    const Volume volume = placed(tile.volume(), place);
    if (!filter_.passes(volume)) return ++list_.beside, base::Result<void>();
    if (auto counted = count_tile(sheet); !counted) return counted;
    add = tile.adds().value_or(add);  // kept on the way down where a tile does not say
    const double error = tile.geometric_error();
    if (const Json& implicit = tile.implicit_tiling(); !implicit.empty())
      return take_implicit(tile, implicit, sheet, {place, volume, error, add, false, 0, 0, "", {}, depth});
    const auto contents = tile.contents();
    const auto children = tile.children();
    const bool has_children = !children.empty();
    const bool descend = has_children && (error > error_ || contents.empty());
    if (add || !descend)
      for (const auto& content : contents)
        if (auto done = take_content(content, sheet, place, depth); !done) return done;
    if (descend)
      for (const TileJson& child : children)
        if (auto done = take_tile(child, sheet, place, add, depth + 1); !done) return done;
    return {};
  }

  /// The file that was given: what it names, at any depth, is in its folder.
  static auto first_of(const Sheet& sheet) -> const fs::path& {
    return sheet.within == nullptr ? sheet.path : first_of(*sheet.within);
  }

  auto take_content(const TileContentName& content, const Sheet& sheet, const Transform& place, int depth)
      -> base::Result<void> {
    if (!filter_.passes(placed(content.volume, place))) return {};
    const fs::path path = address_beside(sheet.path, content.uri);
    if (auto reach = check_reach(first_of(sheet), path); !reach) return reach;
    std::string ending = path.extension().string();
    if (ending.starts_with(".json"))  // maybe with a server's "?key=…"
      return take_file(path, place, &sheet, depth + 1);
    list_.files.push_back({path, sheet.turn, place});
    return {};
  }

  auto take_implicit(const TileJson& tile, const Json& words, const Sheet& sheet, Implicit tree) -> base::Result<void> {
    const auto count = [&words](const char* key) {
      const double number = number_in(words, key).value_or(-1);
      return number >= 0 && number <= 30 ? static_cast<std::uint32_t>(number) : 0U;
    };
    tree.octree = text_in(words, "subdivisionScheme") == "OCTREE";
    tree.subtree_levels = count("subtreeLevels");
    tree.levels = words.contains("availableLevels") ? count("availableLevels") : count("maximumLevel") + 1;
    tree.subtrees = text_in(object_in(words, "subtrees"), "uri");
    tree.contents = tile.contents();
    if (tree.subtree_levels == 0 || tree.subtree_levels > (tree.octree ? 7U : 10U) || tree.subtrees.empty())
      return bad("the implicit tiling does not say its subtrees' levels and address; export the tileset again",
                 sheet.path.string());
    bool apart = tree.levels <= tree.subtree_levels || tells_apart(tree.subtrees, tree.octree);
    for (const auto& content : tree.contents)
      apart = apart && (tree.levels <= 1 || tells_apart(content.uri, tree.octree));
    if (!apart)
      return bad(
          "the implicit tiling has one address for several tiles, without {level}, {x} and {y}; export the "
          "tileset again",
          sheet.path.string());
    return take_subtree(tree, sheet, {});
  }

  static auto tells_apart(const std::string& address, bool octree) -> bool {
    const auto has = [&address](const char* what) { return address.find(what) != address.npos; };
    return has("{level}") && has("{x}") && has("{y}") && (!octree || has("{z}"));
  }

  auto take_subtree(const Implicit& tree, const Sheet& sheet, const TileIndex& root) -> base::Result<void> {
    if (run_.cancelled()) return base::stopped();
    const auto path = address_beside(sheet.path, filled_in(tree.subtrees, root));
    if (auto reach = check_reach(first_of(sheet), path); !reach) return reach;
    const auto subtree = Subtree::read(path, tree.subtree_levels, tree.octree, list_.inputs);
    if (!subtree) return subtree.error();
    return take_index(tree, sheet, *subtree, root, {});
  }

  static auto child_of(const TileIndex& index, unsigned which) -> TileIndex {
    TileIndex child{index.level + 1, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) child.at[axis] = 2 * index.at[axis] + (which >> axis & 1U);
    return child;
  }

  /// `local` is the tile's place in the subtree, `index` in the whole tree.
  auto take_index(const Implicit& tree, const Sheet& sheet, const Subtree& subtree, const TileIndex& index,
                  const TileIndex& local) -> base::Result<void> {
    if (index.level >= tree.levels || !subtree.has_tile(local)) return {};
    if (!filter_.passes(part_of(tree.volume, index, tree.octree))) return ++list_.beside, base::Result<void>();
    if (local.level == tree.subtree_levels) return take_subtree(tree, sheet, index);
    if (auto counted = count_tile(sheet); !counted) return counted;
    const unsigned ways = tree.octree ? 8 : 4;
    bool has_children = false, has_content = false;
    for (unsigned i = 0; i < ways && index.level + 1 < tree.levels; ++i)
      has_children = has_children || subtree.has_tile(child_of(local, i));
    for (std::size_t i = 0; i < tree.contents.size(); ++i) has_content = has_content || subtree.has_content(i, local);
    const double error = std::ldexp(tree.error, -static_cast<int>(index.level));
    const bool descend = has_children && (error > error_ || !has_content);
    if (tree.add || !descend)
      for (std::size_t i = 0; i < tree.contents.size(); ++i)
        if (subtree.has_content(i, local))
          if (auto done = take_content({filled_in(tree.contents[i].uri, index), {}}, sheet, tree.place, tree.depth);
              !done)
            return done;
    for (unsigned i = 0; i < ways && descend; ++i)
      if (auto done = take_index(tree, sheet, subtree, child_of(index, i), child_of(local, i)); !done) return done;
    return {};
  }

  const double error_;
  const UpAxis up_;
  const TileFilter& filter_;
  const base::Run& run_;
  TileList list_;
  std::size_t tiles_ = 0;
};

/// A path as GDAL and the system know it.
auto plain_path(std::string uri) -> std::string {
  std::ranges::replace(uri, '\\', '/');
  return without_percent(uri);
}

}  // namespace

auto address_beside(const fs::path& file, const std::string& uri) -> fs::path {
  if (uri.starts_with("http://") || uri.starts_with("https://")) return "/vsicurl/" + uri;
  std::string folder = file.string();
  const bool server = folder.starts_with("/vsicurl/");
  // What stands behind '?' is for a server, and no part of a name on disk.
  if (server) folder = folder.substr(0, folder.find('?'));
  folder = folder.substr(0, folder.rfind('/') == folder.npos ? 0 : folder.rfind('/') + 1);
  std::string rest = server ? uri : plain_path(uri.substr(0, uri.find_first_of("?#")));
  if (rest.starts_with("/")) {
    const auto host = server ? folder.find("//") : folder.npos;
    return host == folder.npos ? rest : folder.substr(0, folder.find('/', host + 2)) + rest;
  }
  // By hand, since archives and servers do not know "..".
  const std::string path = rest.substr(0, rest.find('?')), query = rest.substr(path.size());
  for (std::size_t from = 0; from <= path.size();) {
    const auto slash = std::min(path.find('/', from), path.size());
    const std::string step = path.substr(from, slash - from);
    from = slash + 1;
    if (step == "." || step.empty()) continue;
    const bool climbs = step == ".." && folder.size() > 1 && !folder.ends_with("../");
    if (climbs) folder.resize(folder.rfind('/', folder.size() - 2) + 1);  // npos + 1 is 0
    else folder += step + (slash < path.size() ? "/" : "");
  }
  return folder + query;
}

auto Tileset::open(const fs::path& path) -> base::Result<Tileset> {
  const std::string name = path.string();
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.error();
  const auto tileset = parse_tileset(bytes->view(), name);
  if (!tileset) return tileset.error();
  const TileJson root = tileset->root();
  const auto place = transform_of(root, name);
  if (!place) return place.error();
  Tileset out;
  out.path_ = path;
  const Volume volume = placed(root.volume(), *place);
  if (const auto* region = std::get_if<DegreeBox>(&volume)) {
    out.geocentric_ = true;
    out.middle_ = from_degrees((region->west + region->east) / 2, (region->south + region->north) / 2, 0);
    return out;
  }
  const auto* box = std::get_if<TileBox>(&volume);
  out.middle_ = box == nullptr ? (*place)({0, 0, 0}) : box->middle;
  Point3 half;
  if (box != nullptr)
    for (const Point3 h : box->half) half = half + Point3{std::abs(h.x), std::abs(h.y), std::abs(h.z)};
  out.geocentric_ = looks_geocentric(out.middle_, length(half), *place);
  if (box == nullptr || out.geocentric_) return out;
  out.plan_.add(xy(box->middle - half));
  out.plan_.add(xy(box->middle + half));
  return out;
}

auto Tileset::tiles(double error, UpAxis up, const TileFilter& filter, const base::Run& run) const
    -> base::Result<TileList> {
  Walk walk(error, up, filter, run);
  if (auto done = walk.take_root(path_); !done) return done.error();
  return walk.list();
}

}  // namespace mansard::formats
