// Headers and values of Stanford PLY, for meshes and for points.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] auto size_of(Type type) -> std::size_t;

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count;  ///< of a list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { none, ascii, little, big };

struct PlyHeader {
  Encoding format = Encoding::none;
  std::vector<Element> elements;
  [[nodiscard]] auto find(std::string_view name) const -> const Element*;
};

/// The body's values one after the other, as text. After the end, or a word that is no number, `failed` stays set.
struct TextValues {
  std::string_view rest;
  bool failed = false;

  auto take(Type) -> double {
    const auto value = to_coordinate(take_word(rest));
    failed = failed || !value;
    return value.value_or(0);
  }
  static auto least(Type) -> std::size_t { return 2; }  // a digit and a blank
  /// Whether what failed was a bad word rather than the end.
  [[nodiscard]] auto more() const -> bool {
    std::string_view look = rest;
    return !take_word(look).empty();
  }
};

template <std::endian order>
struct BinaryValues {
  std::string_view rest;
  bool failed = false;

  auto take(Type type) -> double {
    switch (type) {
      case Type::int8: return take_as<std::int8_t>();
      case Type::uint8: return take_as<std::uint8_t>();
      case Type::int16: return take_as<std::int16_t>();
      case Type::uint16: return take_as<std::uint16_t>();
      case Type::int32: return take_as<std::int32_t>();
      case Type::uint32: return take_as<std::uint32_t>();
      case Type::float32: return static_cast<double>(take_as<float>());
      case Type::float64: return take_as<double>();
    }
    return 0;
  }
  static auto least(Type type) -> std::size_t { return size_of(type); }
  /// Bytes cannot be bad, only too few.
  [[nodiscard]] static auto more() -> bool { return false; }

 private:
  template <class T>
  auto take_as() -> T {
    std::array<char, sizeof(T)> bytes{};
    if (rest.size() < sizeof(T)) return failed = true, T{};
    std::memcpy(bytes.data(), rest.data(), sizeof(T));
    rest.remove_prefix(sizeof(T));
    if constexpr (order != std::endian::native)
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    return std::bit_cast<T>(bytes);
  }
};

/// "ingest-mesh-truncated": the file ends before `what`.
[[nodiscard]] auto truncated(const std::string& what, const std::string& name) -> base::Diagnostic;

/// Takes the header off the front; the body follows its last line's end exactly. Fails with "ingest-mesh-format",
/// "ingest-mesh-truncated".
[[nodiscard]] auto take_header(std::string_view& bytes, const std::string& name) -> base::Result<PlyHeader>;

}  // namespace mansard::formats::ply
