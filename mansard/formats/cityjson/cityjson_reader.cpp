// Reads buildings back from CityJSON and CityJSONSeq that mansard wrote, those of version 0.1 too, where the plan was
// an attribute without '+' and "metadata" said how the file was made.
#include <fstream>
#include <map>
#include <set>
#include <span>

#include "mansard/base/files.hpp"
#include "mansard/formats/cityjson/cityjson.hpp"
#include "mansard/formats/cityjson/cityjson_model.hpp"
#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/model/append.hpp"

namespace mansard::formats::detail {
namespace {

constexpr std::array<std::string_view, 2> plan_names{plan_name, old_plan_name};

/// The attribute of a city object that is an object and has one of these names; none where there is none. A feature may
/// have an attribute of such a name from elsewhere.
auto find_own(const Json& object, std::span<const std::string_view> names) -> std::pair<std::string_view, const Json*> {
  const auto attributes = object.is_object() ? object.find("attributes") : object.end();
  if (attributes != object.end() && attributes->is_object())
    for (const auto name : names)
      if (const auto found = attributes->find(name); found != attributes->end() && found->is_object())
        return {name, &*found};
  return {{}, nullptr};
}

/// The attributes that have a type of ours; other tools may have put in anything.
auto read_plain_attributes(const Json& object) -> model::Attributes {
  Json plain = Json::object();
  if (const auto found = object.find("attributes"); found != object.end() && found->is_object())
    for (const auto& [key, value] : found->items())
      if (!value.is_structured()) plain[from_undeclared(key)] = value;
  return read_attributes({plain, {}});
}

/// Whether there are parts, and none has a plan: another tool took them out.
auto has_parts_without_plans(const Json& objects) -> bool {
  bool parts = false;
  for (const auto& object : objects) {
    if (find_own(object, plan_names).second != nullptr) return false;
    parts = parts || (object.is_object() && object.contains("type") && object["type"] == "BuildingPart");
  }
  return parts;
}

/// How the file was made and what its coordinates are relative to; nothing for a file that says neither.
auto read_file_header(const Item& file) -> std::optional<Header> {
  Header header;
  const Item objects = file.member("CityObjects");
  if (!objects.json.is_object()) objects.refuse("an object");
  if (file.has("+mansard")) {
    const Item own = file.member("+mansard");
    header.made_by = read_made_by(own.member("made_by"));
    header.frame = read_frame(own.member("frame"));
    if (!has_parts_without_plans(objects.json)) return header;
    return std::nullopt;
  }
  if (file.has("metadata")) {
    const Item metadata = file.member("metadata");
    if (metadata.has("mansard")) header.made_by = read_made_by(metadata.member("mansard"));
    if (metadata.has("referenceSystem")) {
      const std::string system = metadata.member("referenceSystem").text();
      if (const auto at = system.find("/EPSG/"); at != std::string::npos)
        header.frame.crs = "EPSG:" + system.substr(system.rfind('/') + 1);
    }
  }
  for (const auto& [id, object] : objects.json.items())
    if (const auto [name, plan] = find_own(object, plan_names); plan != nullptr) {
      const Place place{&objects.place, id, 0}, inner{&place, name, 0};
      const Item found{*plan, inner};
      header.frame.origin = read_origin(found.member("origin"));
      return header;
    }
  return std::nullopt;
}

/// Whether the solids of LoD 2.2 of a file are those of parts, which they always were before version 0.3, or of
/// buildings, or left out.
auto models_in(const Item& file) -> Models {
  if (!file.has("+mansard")) return Models::of_parts;
  const Item own = file.member("+mansard");
  if (!own.has("solids")) return Models::of_parts;
  const std::string solids = own.member("solids").text();
  return solids == "part" ? Models::of_parts : solids == "none" ? Models::none : Models::of_buildings;
}

[[noreturn]] void refuse_foreign(const std::string& code) {
  throw Defect{code, "this CityJSON carries no plans (no part has an attribute \"" + std::string(plan_name) +
                         "\"); give a file that mansard wrote"};
}

/// Reads the buildings among city objects.
class Objects {
 public:
  /// Without vertices there are no models.
  Objects(const Item& objects, const Vertices* vertices, const model::Frame& frame, Models models)
      : objects_(objects), vertices_(vertices), origin_(frame.origin), models_(models) {
    if (!objects.json.is_object()) objects.refuse("an object");
    for (const auto& [id, object] : objects.json.items()) object_of_.emplace(id, &object);
  }

  [[nodiscard]] auto building(const std::string& id, const Json& json) -> model::Building {
    const Item object{json, {&objects_.place, id, 0}};
    model::Building building;
    building.id = id;
    building.attributes = read_plain_attributes(json);
    constexpr std::array<std::string_view, 1> names{footprint_name};
    if (const auto [name, own] = find_own(json, names); own != nullptr)
      read_own_footprint({*own, {&object.place, name, 0}}, building);
    else if (vertices_ != nullptr) read_lod_0(object, *vertices_, building);
    std::vector<Found> solids;
    std::map<std::string, std::size_t, std::less<>> number;  // of parts
    if (object.has("children"))
      object.member("children").each([&](const Item& child) {
        const auto found = object_of_.find(child.text());
        if (found == object_of_.end()) child.refuse("the id of a city object");
        // Of a plan that is named a thousand times there would be a thousand.
        if (!taken_.insert(found->first).second) child.refuse("the id of a city object that is named once");
        const Place place{&objects_.place, found->first, 0};
        find_solid({*found->second, place}, {std::string(found->first)}, solids);
        auto part = read_part(found->first, *found->second);
        if (!part) return;
        number.emplace(found->first, building.parts.size());
        building.parts.push_back(*std::move(part));
      });
    std::vector<std::string> all;
    for (const auto& part : building.parts) all.push_back(part.id);
    find_solid(object, std::move(all), solids);
    for (auto& solid : solids) {
      std::vector<std::size_t> parts;
      for (const auto& name : solid.of)
        if (const auto part = number.find(name); part != number.end()) parts.push_back(part->second);
      std::ranges::sort(parts);
      if (parts.empty()) continue;
      if (models_ == Models::of_parts) model::append(solid.model, building.parts[parts.front()].model);
      building.solids.push_back({std::move(parts), std::move(solid.model)});
    }
    // Pieces of a part come after all parts in a file, and after their part when they are written.
    std::ranges::stable_sort(building.solids, {}, [](const auto& solid) { return solid.parts.front(); });
    return building;
  }

  [[nodiscard]] static auto is_building(const Json& json) -> bool {
    return json.is_object() && json.contains("type") && json["type"] == "Building";
  }

 private:
  void read_own_footprint(const Item& own, model::Building& building) const {
    own.object({"origin", "ground", "polygons"});
    const auto offset = offset_between(read_origin(own.member("origin")), origin_);
    building.ground = own.member("ground").number_up_to(farthest) + offset.z;
    building.footprint = read_footprint(own.member("polygons"));
    if (offset == geometry::Point3{}) return;
    for (auto& polygon : building.footprint) {
      for (auto& p : polygon.outer) p = p + geometry::Point2{offset.x, offset.y};
      for (auto& hole : polygon.holes)
        for (auto& p : hole) p = p + geometry::Point2{offset.x, offset.y};
    }
  }

  [[nodiscard]] auto read_part(std::string_view id, const Json& json) const -> std::optional<model::Part> {
    const auto [name, plan] = find_own(json, plan_names);
    if (plan == nullptr) return std::nullopt;
    const Item object{json, {&objects_.place, id, 0}};
    model::Part part{std::string(id),
                     read_embedded_plan({*plan, {&object.place, name, 0}}, origin_),
                     {},
                     read_plain_attributes(json)};
    return part;
  }

  struct Found {
    std::vector<std::string> of;  ///< parts
    model::LabelledSolid model;
  };
  /// The solid of an object, which is of these parts unless it names others.
  void find_solid(const Item& object, std::vector<std::string> of, std::vector<Found>& solids) const {
    if (models_ == Models::none || vertices_ == nullptr) return;
    auto model = read_model(object, *vertices_);
    if (model.solid.faces.empty()) return;
    if (object.has("attributes")) {
      const Item attributes = object.member("attributes");
      if (attributes.json.is_object() && attributes.has(std::string(solid_of_name).c_str())) {
        of.clear();
        attributes.member(solid_of_name).each([&](const Item& name) { of.push_back(name.text()); });
      }
    }
    solids.push_back({std::move(of), std::move(model)});
  }

  const Item& objects_;
  const Vertices* vertices_;
  const std::array<std::int64_t, 3> origin_;
  const Models models_;
  std::map<std::string_view, const Json*> object_of_;
  std::set<std::string_view> taken_;  ///< as children
};

auto read_whole_file(const Item& file, bool models, const std::string& code) -> model::City {
  const auto header = read_file_header(file);
  if (!header) refuse_foreign(code);
  model::City city{header->frame, header->made_by, {}};
  const Item transform = file.member("transform"), list = file.member("vertices"), all = file.member("CityObjects");
  const Vertices vertices(transform, list, city.frame.origin);
  Objects objects(all, &vertices, city.frame, models ? models_in(file) : Models::none);
  for (const auto& [id, object] : all.json.items())
    if (Objects::is_building(object)) city.buildings.push_back(objects.building(id, object));
  return city;
}

/// A feature a line; no more than one line is in memory.
class ReadFeatures : public CityReader {
 public:
  ReadFeatures(std::string name, std::ifstream file, Header header, std::string transform, Models models)
      : name_(std::move(name)),
        file_(std::move(file)),
        header_(std::move(header)),
        transform_(std::move(transform)),
        models_(models) {}
  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return models_ == Models::of_parts; }
  [[nodiscard]] auto has_solids() const -> bool override { return models_ == Models::of_buildings; }
  [[nodiscard]] auto next() -> base::Result<std::optional<model::Building>> override {
    for (std::string line; std::getline(file_, line);) {
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      auto building = parsed<model::Building>(line, name_ + ":" + std::to_string(line_),
                                              [&](const Item& feature) { return read_feature(feature); });
      if (!building) return building.error();
      return std::optional<model::Building>(*std::move(building));
    }
    if (file_.bad()) return base::error("file-read", "cannot read this file to its end; is it whole?", name_);
    return std::optional<model::Building>();
  }

 private:
  [[nodiscard]] auto read_feature(const Item& feature) const -> model::Building {
    if (!feature.json.is_object() || !feature.has("type") || feature.json["type"] != "CityJSONFeature")
      feature.refuse("a \"CityJSONFeature\"");
    const Json at = parse_json(transform_);
    const Item transform{at, {}}, list = feature.member("vertices"), all = feature.member("CityObjects");
    const Vertices vertices(transform, list, header_.frame.origin);
    Objects objects(all, &vertices, header_.frame, models_);
    const std::string id = feature.member("id").text();
    const auto found = all.json.find(id);
    if (found == all.json.end() || !Objects::is_building(*found))
      all.refuse("objects with the building \"" + id + "\"");
    return objects.building(id, *found);
  }

  const std::string name_;
  std::ifstream file_;
  const Header header_;
  const std::string transform_;
  const Models models_;
  std::size_t line_ = 1;
};

auto open_features(std::ifstream file, const std::string& first, const std::string& name) -> ReaderResult {
  std::string transform;
  auto models = Models::of_parts;
  const auto header = parsed<Header>(first, name + ":1", [&](const Item& item) {
    transform = item.member("transform").json.dump();
    auto found = read_file_header(item);
    if (!found) refuse_foreign("write-read-plans");
    models = models_in(item);
    return *std::move(found);
  });
  if (!header) return header.error();
  return ReaderResult(std::make_unique<ReadFeatures>(name, std::move(file), *header, std::move(transform), models));
}

/// Whether the first line is a whole object and another follows.
auto is_sequence(std::ifstream& file, std::string& first) -> bool {
  std::getline(file, first);
  while (!first.empty() && (first.back() == '\r' || first.back() == ' ')) first.pop_back();
  return first.starts_with('{') && first.ends_with('}') && Json::accept(first);
}

}  // namespace

auto read_cityjson_plans(const Item& file) -> model::City { return read_whole_file(file, false, "write-plan-type"); }

auto cityjson_reader(const Path& path) -> ReaderResult {
  const std::string name = path.string();
  std::error_code status;
  if (!std::filesystem::is_directory(path, status)) {
    std::ifstream file(path, std::ios::binary);
    std::string first;
    const bool sequence = file && is_sequence(file, first);
    // A whole CityJSON may stand on one line, too: then nothing follows, and it has objects of its own.
    const bool more = sequence && file.peek() != std::ifstream::traits_type::eof();
    if (more || (sequence && first.find("\"CityObjects\":{}") != std::string::npos))
      return open_features(std::move(file), first, name);
  }
  const auto text = base::read_file(path);
  if (!text) return text.error();
  auto models = Models::of_parts;
  auto city = parsed<model::City>(*text, name, [&](const Item& file) {
    if (!file.json.is_object() || !file.has("type") || file.json["type"] != "CityJSON")
      throw Defect{"write-read-format", "this is JSON but not CityJSON; give a file that mansard wrote"};
    auto read = read_whole_file(file, true, "write-read-plans");
    models = models_in(file);
    return read;
  });
  if (!city) return city.error();
  return ReaderResult(whole_reader(*std::move(city), models));
}

}  // namespace mansard::formats::detail
