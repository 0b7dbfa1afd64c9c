// The JSON of a tileset of 3D Tiles, looked into without trust: its root and what a tile says, for all who go down the
// tree. Members of another kind than the standard says count as missing.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/formats/mesh/transform.hpp"
#include "mansard/formats/tiles3d/tile_volume.hpp"

namespace mansard::formats {

/// A member that is an object, or an empty one.
[[nodiscard]] auto object_in(const nlohmann::ordered_json& from, const char* key) -> const nlohmann::ordered_json&;
/// Empty if there is none.
[[nodiscard]] auto text_in(const nlohmann::ordered_json& from, const char* key) -> std::string;
[[nodiscard]] auto number_in(const nlohmann::ordered_json& from, const char* key) -> std::optional<double>;

struct TileContentName {
  std::string uri;
  Volume volume;
};

/// A tile of a tileset, or of a tileset named by another.
class TileJson {
 public:
  /// `json` must outlive it.
  explicit TileJson(const nlohmann::ordered_json& json) : json_(json) {}
  [[nodiscard]] auto is_object() const -> bool { return json_.is_object(); }
  /// Unit if there is none; nothing for one that is not 16 numbers.
  [[nodiscard]] auto transform() const -> std::optional<Transform>;
  [[nodiscard]] auto volume() const -> Volume { return volume_of(object_in(json_, "boundingVolume")); }
  [[nodiscard]] auto stated_error() const -> std::optional<double> { return number_in(json_, "geometricError"); }
  [[nodiscard]] auto geometric_error() const -> double { return stated_error().value_or(0); }
  /// Whether the content of its children is added to its own; nothing if it does not say.
  [[nodiscard]] auto adds() const -> std::optional<bool>;
  /// One content, several (1.1), or several by the extension to 1.0.
  [[nodiscard]] auto contents() const -> std::vector<TileContentName>;
  /// "implicitTiling", or that of the extension to 1.0; empty if there is none.
  [[nodiscard]] auto implicit_tiling() const -> const nlohmann::ordered_json&;
  [[nodiscard]] auto children() const -> std::vector<TileJson>;

 private:
  const nlohmann::ordered_json& json_;
};

class TilesetJson {
 public:
  enum class Fault : std::uint8_t { none, too_deep, not_a_tileset };
  /// A tileset is an object with a root; more is up to the reader.
  explicit TilesetJson(std::string_view bytes);
  [[nodiscard]] auto fault() const -> Fault { return fault_; }
  [[nodiscard]] auto json() const -> const nlohmann::ordered_json& { return json_; }
  [[nodiscard]] auto asset() const -> const nlohmann::ordered_json& { return object_in(json_, "asset"); }
  [[nodiscard]] auto root() const -> TileJson { return TileJson(json_["root"]); }
  /// The first of "extensionsRequired" that is none of those that the readers know.
  [[nodiscard]] auto unknown_extension() const -> std::optional<std::string>;

 private:
  nlohmann::ordered_json json_;
  Fault fault_ = Fault::none;
};

}  // namespace mansard::formats
