// The formats that mansard-reader reads. Each ends with a scene, or says what is wrong.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "mansard/formats/outside/scene.hpp"

namespace mansard::reader {

/// The bytes are not in the format: what the library says.
class Wrong : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// The bytes end before what they promise.
class Truncated : public std::exception {};

/// OpenSceneGraph's binary format. Throws Wrong, Truncated.
[[nodiscard]] auto read_osgb(std::string_view bytes) -> formats::outside::Scene;
/// "stl", "dae" or "fbx". Throws Wrong.
[[nodiscard]] auto read_assimp(std::string_view bytes, const std::string& extension) -> formats::outside::Scene;

}  // namespace mansard::reader
