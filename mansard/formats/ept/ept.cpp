#include "mansard/formats/ept/ept.hpp"

#include <array>
#include <cmath>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/json/json_access.hpp"
#include "mansard/formats/las/las_crs.hpp"
#include "mansard/formats/las/las_file.hpp"

namespace mansard::formats {
namespace {

using Key = std::array<std::int64_t, 4>;

auto name_of_key(const Key& key) -> std::string {
  std::string name;
  for (const auto number : key) name += (name.empty() ? "" : "-") + std::to_string(number);
  return name;
}

/// "2-0-1-3", within its level.
auto key_of(std::string_view name) -> std::optional<Key> {
  Key key{};
  for (std::size_t i = 0; i < key.size(); ++i) {
    const auto end = name.find('-');
    if ((end == name.npos) != (i + 1 == key.size())) return std::nullopt;
    const auto number = base::to_integer(name.substr(0, end));
    if (!number) return std::nullopt;
    key[i] = *number;
    name.remove_prefix(end == name.npos ? name.size() : end + 1);
  }
  if (key[0] < 0 || key[0] > 30) return std::nullopt;
  for (std::size_t axis = 1; axis < 4; ++axis)
    if (key[axis] < 0 || key[axis] >= std::int64_t{1} << key[0]) return std::nullopt;
  return key;
}

auto box_of_json(const Json& json) -> std::optional<geometry::Box3> {
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < n.size(); ++i) {
    const Json& number = item(json, i);
    if (!number.is_number() || !std::isfinite(number.get<double>())) return std::nullopt;
    n[i] = number.get<double>();
  }
  if (n[0] > n[3] || n[1] > n[4] || n[2] > n[5]) return std::nullopt;
  return geometry::Box3{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

class EptCloud : public PointCloud {
 public:
  explicit EptCloud(const std::filesystem::path& path) : path_(path), name_(path.string()) {}

  [[nodiscard]] auto open() -> base::Result<void> {
    const auto bytes = read_small(path_);
    if (!bytes) return bytes.failure();
    const Json json = Json::parse(*bytes, nullptr, false);
    if (!json.is_object()) return bad("is not a JSON object");
    const auto type = text_of(member(json, "dataType"));
    if (type != "laszip")
      return base::error(
          "ingest-points-unsupported",
          "its data type is '" + base::on_one_line(type) + "', and 'laszip' is read; build it again with that", name_);
    const auto cube = box_of_json(member(json, "bounds"));
    const Json& points = member(json, "points");
    if (!cube) return bad("has no finite bounds");
    if (!points.is_number_unsigned()) return bad("has no number of points");
    cube_ = *cube;
    if (auto read = read_hierarchy(); !read) return read;
    std::uint64_t sum = 0;
    for (const auto& node : nodes_) sum += node.points;
    if (sum != points.get<std::uint64_t>())
      return bad("counts " + std::to_string(points.get<std::uint64_t>()) + " points, and its hierarchy has " +
                 std::to_string(sum));
    describe(json, sum);
    return {};
  }

  [[nodiscard]] auto info() const -> const PointInfo& override { return info_; }
  [[nodiscard]] auto pieces() const -> std::size_t override { return nodes_.size(); }
  [[nodiscard]] auto points_of(std::size_t piece) const -> std::uint64_t override { return nodes_[piece].points; }
  [[nodiscard]] auto box_of(std::size_t piece) const -> std::optional<geometry::Box3> override {
    const Key& key = nodes_[piece].key;
    const auto size = cube_.most - cube_.least;
    const double part = std::ldexp(1, -static_cast<int>(key[0])), margin = 0.001;
    const auto from = [&](double least, double whole, std::int64_t k) {
      return least + whole * part * (static_cast<double>(k) - margin);
    };
    const geometry::Point3 least{from(cube_.least.x, size.x, key[1]), from(cube_.least.y, size.y, key[2]),
                                 from(cube_.least.z, size.z, key[3])};
    return geometry::Box3{least, least + (part * (1 + 2 * margin)) * size};
  }

  [[nodiscard]] auto read(std::size_t piece) const -> base::Result<std::vector<CloudPoint>> override {
    auto node = LasFile::open(file_of(piece));
    if (!node) return node.failure();
    if ((*node)->info().points != nodes_[piece].points)
      return base::error("ingest-points-format",
                         "node " + name_of_key(nodes_[piece].key) + " has " + std::to_string((*node)->info().points) +
                             " points, and the hierarchy counts " + std::to_string(nodes_[piece].points) +
                             "; copy or build it again",
                         name_);
    std::vector<CloudPoint> all;
    for (std::size_t i = 0; i < (*node)->pieces(); ++i) {
      auto some = (*node)->read(i);
      if (!some) return some.failure();
      all.insert(all.end(), some->begin(), some->end());
    }
    return all;
  }

  [[nodiscard]] auto inputs() const -> base::Result<std::vector<model::InputFile>> override { return inputs_; }

 private:
  struct Node {
    Key key{};
    std::uint64_t points = 0;
  };

  [[nodiscard]] auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-points-format", "the EPT set " + what + "; copy or build it again", name_);
  }
  [[nodiscard]] auto folder() const -> std::filesystem::path { return path_.parent_path(); }
  [[nodiscard]] auto file_of(std::size_t piece) const -> std::filesystem::path {
    return folder() / "ept-data" / (name_of_key(nodes_[piece].key) + ".laz");
  }
  /// A file of the index, which is one of the inputs.
  auto read_small(const std::filesystem::path& path) -> base::Result<std::string> {
    const auto bytes = bytes_of_named(path);
    if (!bytes) return bytes.failure();
    inputs_.push_back({path.string(), bytes->view().size(), sha256(bytes->view())});
    return std::string(bytes->view());
  }

  [[nodiscard]] auto read_hierarchy() -> base::Result<void> {
    std::vector<Key> open{Key{}};
    std::set<Key> pages{Key{}}, keys;
    while (!open.empty()) {
      const auto page = open.back();
      open.pop_back();
      const auto bytes = read_small(folder() / "ept-hierarchy" / (name_of_key(page) + ".json"));
      if (!bytes) return bytes.failure();
      const Json json = Json::parse(*bytes, nullptr, false);
      if (!json.is_object()) return bad("has no valid hierarchy in " + name_of_key(page) + ".json");
      for (const auto& [name, count] : json.items()) {
        const auto key = key_of(name);
        if (!key || !count.is_number_integer())
          return bad("names '" + base::on_one_line(name.substr(0, 40)) + "' in its hierarchy, which is not a node");
        const auto points = count.get<std::int64_t>();
        if (points == -1) {
          if (!pages.insert(*key).second) return bad("names the hierarchy file " + name + ".json twice");
          open.push_back(*key);
          continue;
        }
        if (points < 0) return bad("counts " + std::to_string(points) + " points in node " + name);
        if (!keys.insert(*key).second) return bad("names node " + name + " twice");
        if (points > 0) nodes_.push_back({*key, static_cast<std::uint64_t>(points)});
      }
    }
    std::ranges::sort(nodes_, {}, &Node::key);
    return {};
  }

  void describe(const Json& json, std::uint64_t points) {
    info_.format = "EPT " + base::on_one_line(text_of(member(json, "version")));
    info_.points = points;
    info_.stated_bounds = box_of_json(member(json, "boundsConforming"));
    const Json& srs = member(json, "srs");
    auto crs = crs_of_wkt(text_of(member(srs, "wkt")));
    if (const auto code = text_of(member(srs, "horizontal")); !crs && !code.empty())
      if (auto named = crs::mesh_crs(text_of(member(srs, "authority")) + ":" + code))
        crs = CloudCrs{std::move(*named), 1, text_of(member(srs, "authority")) + ":" + code};
    if (crs) {
      info_.crs = std::move(crs->crs);
      info_.crs_title = std::move(crs->title);
      info_.unit = crs->unit;
    }
    for (const Json& dimension : member(json, "schema")) {
      const auto name = text_of(member(dimension, "name"));
      info_.has_classes = info_.has_classes || name == "Classification";
      info_.has_returns = info_.has_returns || name == "NumberOfReturns";
      info_.has_colours = info_.has_colours || name == "Red";
    }
  }

  std::filesystem::path path_;
  std::string name_;
  geometry::Box3 cube_;
  std::vector<Node> nodes_;
  std::vector<model::InputFile> inputs_;
  PointInfo info_;
};

}  // namespace

auto open_ept(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>> {
  auto out = std::make_unique<EptCloud>(path);
  if (auto opened = out->open(); !opened) return opened.failure();
  return std::unique_ptr<PointCloud>(std::move(out));
}

}  // namespace mansard::formats
