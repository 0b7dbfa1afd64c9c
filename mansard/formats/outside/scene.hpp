// What mansard-reader answers with: the meshes of a file, and the files that it refers to. Both programs include this
// header; what comes from the other side is checked when it is unpacked.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mansard::formats::outside {

struct Picture {
  std::string bytes;                   ///< as the file has them; empty where the picture is a file of its own
  std::string file;                    ///< as the file names it
  std::array<std::uint8_t, 2> wrap{};  ///< as enum Wrap
};

struct Mesh {
  std::vector<std::array<double, 3>> vertices;          ///< in the coordinates of the file
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< may name vertices that do not exist
  std::vector<std::array<float, 2>> uv;                 ///< per vertex, or none; from the bottom left corner
  std::vector<std::array<std::uint8_t, 3>> colours;     ///< per vertex, one for all, or none; sRGB
  std::int32_t picture = -1;                            ///< of the scene; -1 for none
};

/// Levels of detail of one thing, or what is not one: then all children are of one level.
struct Node {
  struct Child {
    float rank = 0;          ///< the finest level has the smallest
    std::string file;        ///< with the child, as this file names it; empty: `node` has it
    std::uint32_t node = 0;  ///< of the scene
  };
  std::vector<Child> children;
  std::vector<std::uint32_t> meshes;  ///< of the scene
};

struct Scene {
  std::vector<Node> nodes;  ///< the first is the root; children come after their parents
  std::vector<Mesh> meshes;
  std::vector<Picture> pictures;
  std::uint8_t y_up = 0;
  double farthest = 0;  ///< the largest coordinate that was in single precision, in metres
  std::uint64_t short_faces = 0;
};

// ---- as bytes: numbers as the machine has them, lengths before their items

class Packer {
 public:
  template <class T>
  void take(const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      size(value.size());
      out_ += value;
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  template <class T>
  void take(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    size(values.size());
    if (!values.empty()) out_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void size(std::size_t count) { take(static_cast<std::uint64_t>(count)); }
  [[nodiscard]] auto bytes() -> std::string { return std::move(out_); }

 private:
  std::string out_;
};

/// The way back. ok() is false from the first thing on that is not there.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void take(T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      const auto count = size(1);
      value.assign(rest_.substr(0, count));
      rest_.remove_prefix(count);
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      if (!has(sizeof value)) return;
      std::memcpy(&value, rest_.data(), sizeof value);
      rest_.remove_prefix(sizeof value);
    }
  }
  template <class T>
  void take(std::vector<T>& values) {
    const auto count = size(sizeof(T));
    values.resize(count);
    if (count == 0) return;
    std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
  }
  /// A number of items of so many bytes at least, which are there.
  auto size(std::size_t each) -> std::size_t {
    std::uint64_t count = 0;
    take(count);
    ok_ = ok_ && count <= rest_.size() / each;
    return ok_ ? static_cast<std::size_t>(count) : 0;
  }
  [[nodiscard]] auto ok() const -> bool { return ok_; }
  [[nodiscard]] auto at_end() const -> bool { return ok_ && rest_.empty(); }

 private:
  auto has(std::size_t bytes) -> bool {
    ok_ = ok_ && bytes <= rest_.size();
    return ok_;
  }
  std::string_view rest_;
  bool ok_ = true;
};

/// The same for both ways: `items` grows on the way back.
template <class Way, class S>
void each(Way& way, S& scene) {
  constexpr bool packs = std::is_same_v<Way, Packer>;
  const auto all = [&](auto& items, auto one) {
    if constexpr (packs) way.size(items.size());
    else items.resize(way.size(1));
    for (auto& item : items) one(item);
  };
  all(scene.nodes, [&](auto& node) {
    all(node.children, [&](auto& child) {
      way.take(child.rank);
      way.take(child.file);
      way.take(child.node);
    });
    way.take(node.meshes);
  });
  all(scene.meshes, [&](auto& mesh) {
    way.take(mesh.vertices);
    way.take(mesh.triangles);
    way.take(mesh.uv);
    way.take(mesh.colours);
    way.take(mesh.picture);
  });
  all(scene.pictures, [&](auto& picture) {
    way.take(picture.bytes);
    way.take(picture.file);
    way.take(picture.wrap);
  });
  way.take(scene.y_up);
  way.take(scene.farthest);
  way.take(scene.short_faces);
}

inline auto packed(const Scene& scene) -> std::string {
  Packer packer;
  each(packer, scene);
  return packer.bytes();
}

/// Whether the bytes are a scene whose numbers lead where they may.
inline auto unpack(std::string_view bytes, Scene& scene) -> bool {
  Unpacker unpacker(bytes);
  each(unpacker, scene);
  if (!unpacker.at_end() || scene.nodes.empty()) return false;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    for (const auto& child : scene.nodes[n].children)
      if (child.file.empty() && (child.node <= n || child.node >= scene.nodes.size())) return false;
    for (const auto mesh : scene.nodes[n].meshes)
      if (mesh >= scene.meshes.size()) return false;
  }
  for (const auto& mesh : scene.meshes)
    if (mesh.picture >= static_cast<std::int32_t>(scene.pictures.size()) ||
        (!mesh.uv.empty() && mesh.uv.size() != mesh.vertices.size()))
      return false;
  return true;
}

// ---- questions and answers, on the socket with this number

inline constexpr int channel = 3;

enum class Outcome : std::uint8_t { scene, wrong, truncated };

}  // namespace mansard::formats::outside
