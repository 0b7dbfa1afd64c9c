#include "mansard/formats/ply/point_reader.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/ply/ply_file.hpp"
#include "mansard/formats/points/field.hpp"
#include "mansard/formats/points/in_memory.hpp"

namespace mansard::formats {
namespace {

using namespace ply;

using Target = PointField;

auto target_of(std::string_view name) -> Target {
  static constexpr std::array<std::pair<std::string_view, Target>, 25> names{{
      {"x", Target::x},
      {"y", Target::y},
      {"z", Target::z},
      {"classification", Target::classification},
      {"Classification", Target::classification},
      {"scalar_Classification", Target::classification},
      {"class", Target::classification},
      {"return_number", Target::return_number},
      {"ReturnNumber", Target::return_number},
      {"scalar_ReturnNumber", Target::return_number},
      {"number_of_returns", Target::returns},
      {"NumberOfReturns", Target::returns},
      {"scalar_NumberOfReturns", Target::returns},
      {"point_source_id", Target::source},
      {"PointSourceId", Target::source},
      {"scalar_PointSourceId", Target::source},
      {"intensity", Target::intensity},
      {"Intensity", Target::intensity},
      {"scalar_Intensity", Target::intensity},
      {"red", Target::red},
      {"green", Target::green},
      {"blue", Target::blue},
      {"diffuse_red", Target::red},
      {"diffuse_green", Target::green},
      {"diffuse_blue", Target::blue},
  }};
  const auto* at = std::ranges::find(names, name, &std::pair<std::string_view, Target>::first);
  return at == names.end() ? Target::none : at->second;
}

/// Colours that are not integers are from 0 to 1, unless they are larger.
auto is_share(Target target, Type type, double value) -> bool {
  return is_colour(target) && (type == Type::float32 || type == Type::float64) && value <= 1;
}

template <class Values>
auto take_points(Values values, const PlyHeader& header, const std::string& name)
    -> base::Result<std::vector<CloudPoint>> {
  std::vector<CloudPoint> points;
  for (const Element& element : header.elements) {
    double least = 0;
    for (const Property& property : element.properties)
      least += static_cast<double>(values.least(property.count.value_or(property.type)));
    if (least * static_cast<double>(element.count) > static_cast<double>(values.rest.size()) + 1)
      return truncated("the " + std::to_string(element.count) + " elements '" + element.name + "' it promises", name);
    const bool vertices = element.name == "vertex";
    std::vector<Target> targets;
    for (const Property& property : element.properties)
      targets.push_back(property.count ? Target::none : target_of(property.name));
    if (element.properties.empty()) continue;
    if (vertices) points.reserve(static_cast<std::size_t>(element.count));
    for (std::int64_t i = 0; i < element.count; ++i) {
      CloudPoint point;
      for (std::size_t p = 0; p < targets.size() && !values.failed; ++p) {
        const Property& property = element.properties[p];
        const double value = values.take(property.count.value_or(property.type));
        put(point, targets[p], is_share(targets[p], property.type, value) ? std::round(255 * value) : value);
        if (!property.count) continue;
        if (!(value >= 0) ||
            value * static_cast<double>(values.least(property.type)) > static_cast<double>(values.rest.size()) + 1)
          values.failed = true;
        for (double k = 0; k < value && !values.failed; ++k) static_cast<void>(values.take(property.type));
      }
      if (values.failed) {
        const std::string which =
            "element " + std::to_string(i + 1) + " of " + std::to_string(element.count) + " of '" + element.name + "'";
        if (!values.more()) return truncated(which, name);
        return base::error("ingest-mesh-format", which + " is broken; export the points again", name);
      }
      if (vertices) points.push_back(point);
    }
    if (vertices) return points;  // what follows holds no points
  }
  return points;
}

auto parse(std::string_view bytes, const std::string& name, PointInfo& info) -> base::Result<std::vector<CloudPoint>> {
  const auto header = take_header(bytes, name);
  if (!header) return header.failure();
  const auto* vertices = header->find("vertex");
  int axes = 0;
  if (vertices != nullptr)
    for (const auto& property : vertices->properties) {
      const auto target = property.count ? Target::none : target_of(property.name);
      axes += target == Target::x || target == Target::y || target == Target::z ? 1 : 0;
      info.has_classes = info.has_classes || target == Target::classification;
      info.has_returns = info.has_returns || target == Target::returns;
      info.has_colours = info.has_colours || target == Target::red;
    }
  if (axes != 3) return base::error("ingest-mesh-format", "the PLY file has no vertices with x, y and z", name);
  switch (header->format) {
    case Encoding::little: return take_points(BinaryValues<std::endian::little>{bytes}, *header, name);
    case Encoding::big: return take_points(BinaryValues<std::endian::big>{bytes}, *header, name);
    default: return take_points(TextValues{bytes}, *header, name);
  }
}

}  // namespace

auto is_point_ply(std::string_view bytes) -> bool {
  const auto header = take_header(bytes, {});
  if (!header) return false;
  const auto* vertices = header->find("vertex");
  const auto none = [&](std::string_view element) {
    const auto* found = header->find(element);
    return found == nullptr || found->count == 0;
  };
  const auto has = [&](std::string_view axis) {
    return std::ranges::any_of(vertices->properties, [&](const Property& p) { return p.name == axis && !p.count; });
  };
  return vertices != nullptr && vertices->count > 0 && none("face") && none("tristrips") && has("x") && has("y") &&
         has("z");
}

auto open_point_ply(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>> {
  const std::string name = path.string();
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.failure();
  PointInfo info;
  auto points = parse(without_mark(bytes->view()), name, info);
  if (!points) {
    // The same faults have the codes of clouds here.
    auto fault = points.error();
    fault.code = fault.code == "ingest-mesh-truncated" ? "ingest-points-truncated" : "ingest-points-format";
    return fault;
  }
  info.format = "PLY";
  model::InputFile input{name, bytes->view().size(), sha256(bytes->view())};
  return std::unique_ptr<PointCloud>(
      std::make_unique<CloudInMemory>(*std::move(points), std::move(info), std::move(input)));
}

}  // namespace mansard::formats
