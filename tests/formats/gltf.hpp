// A GLB read back for tests: accessors, property tables and what was compressed.
#pragma once

#include <meshoptimizer.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace gltf {

using Json = nlohmann::json;
using Float3 = std::array<float, 3>;

template <class T>
auto numbers(const std::string& bytes) -> std::vector<T> {
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

struct Glb {
  Json json;
  std::string binary;

  explicit Glb(const std::string& bytes) {
    const auto size = numbers<std::uint32_t>(bytes.substr(12, 4)).at(0);
    json = Json::parse(bytes.substr(20, size));
    if (20 + size < bytes.size()) binary = bytes.substr(28 + size);
  }

  auto view(std::size_t index) const -> std::string {
    const auto& view = json.at("bufferViews").at(index);
    if (!view.contains("extensions"))
      return binary.substr(view.at("byteOffset").get<std::size_t>(), view.at("byteLength").get<std::size_t>());
    const auto& packed = view["extensions"]["EXT_meshopt_compression"];
    const auto* from =
        reinterpret_cast<const unsigned char*>(binary.data()) + packed.at("byteOffset").get<std::size_t>();
    const std::size_t size = packed.at("byteLength"), stride = packed.at("byteStride"), count = packed.at("count");
    std::string out(stride * count, '\0');
    const int failed = packed.at("mode") == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(reinterpret_cast<void*>(out.data()), count, stride, from, size)
                           : meshopt_decodeVertexBuffer(out.data(), count, stride, from, size);
    if (failed != 0) throw std::runtime_error("a view does not decode");
    if (packed.contains("filter")) meshopt_decodeFilterExp(out.data(), count, stride);
    return out;
  }

  template <class T>
  auto accessor(std::size_t index) const -> std::vector<T> {
    const auto& a = json.at("accessors").at(index);
    const std::string bytes = view(a.at("bufferView"));
    return numbers<T>(bytes.substr(a.at("byteOffset"), a.at("count").get<std::size_t>() * sizeof(T)));
  }

  auto metadata() const -> const Json& { return json.at("extensions").at("EXT_structural_metadata"); }
  auto property(std::size_t table, const std::string& name) const -> const Json& {
    return metadata().at("propertyTables").at(table).at("properties").at(name);
  }
  template <class T>
  auto values(std::size_t table, const std::string& name) const -> std::vector<T> {
    return numbers<T>(view(property(table, name).at("values")));
  }
  auto texts(std::size_t table, const std::string& name) const -> std::vector<std::string> {
    const std::string all = view(property(table, name).at("values"));
    const auto ends = numbers<std::uint32_t>(view(property(table, name).at("stringOffsets")));
    std::vector<std::string> out;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) out.push_back(all.substr(ends[i], ends[i + 1] - ends[i]));
    return out;
  }
};

}  // namespace gltf
