// STL, COLLADA and FBX by the Open Asset Import Library.
#include <assimp/config.h>
#include <assimp/scene.h>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/reader/reader.hpp"

namespace mansard::reader {
namespace {

/// A matrix of the library in double precision: the places of nodes are often far, and their meshes are not.
struct Place {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] auto of(const aiVector3D& v) const -> std::array<double, 3> {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = rows[i][0] * static_cast<double>(v.x) + rows[i][1] * static_cast<double>(v.y) +
               rows[i][2] * static_cast<double>(v.z) + rows[i][3];
    return out;
  }
  [[nodiscard]] auto then(const aiMatrix4x4& m) const -> Place {
    const std::array<std::array<double, 4>, 4> other{
        {{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}, {m.d1, m.d2, m.d3, m.d4}}};
    Place out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        out.rows[i][j] = j == 3 ? rows[i][3] : 0;
        for (std::size_t k = 0; k < 3; ++k) out.rows[i][j] += rows[i][k] * other[k][j];
      }
    return out;
  }
};

class AssimpWalk {
 public:
  AssimpWalk(const aiScene& from, formats::outside::Scene& scene) : from_(from), scene_(scene) {}

  void take(const aiNode& node, const Place& above) {
    const Place place = above.then(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      if (node.mMeshes[i] < from_.mNumMeshes) take(*from_.mMeshes[node.mMeshes[i]], place);
    for (unsigned i = 0; i < node.mNumChildren; ++i) take(*node.mChildren[i], place);
  }

 private:
  void take(const aiMesh& part, const Place& place) {
    auto& mesh = scene_.meshes.emplace_back();
    mesh.vertices.reserve(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      for (const auto c : {v.x, v.y, v.z})
        scene_.farthest = std::max(scene_.farthest, std::abs(static_cast<double>(c)));
      mesh.vertices.push_back(place.of(v));
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) ++scene_.short_faces;
      for (unsigned i = 1; i + 1 < face.mNumIndices; ++i)
        mesh.triangles.push_back({face.mIndices[0], face.mIndices[i], face.mIndices[i + 1]});
    }
  }

  const aiScene& from_;
  formats::outside::Scene& scene_;
};

/// The library asks for the bytes it was given only: no file that is named in them is opened.
class NoFiles : public Assimp::IOSystem {
 public:
  auto Exists(const char* /*file*/) const -> bool override { return false; }
  auto getOsSeparator() const -> char override { return '/'; }
  auto Open(const char* /*file*/, const char* /*mode*/) -> Assimp::IOStream* override { return nullptr; }
  void Close(Assimp::IOStream* /*file*/) override {}
};

/// Metres in a unit of the file: FBX counts in centimetres, times a factor.
auto unit_of(const aiScene& scene) -> double {
  constexpr double centimetre = 0.01;
  float factor = 1;
  if (scene.mMetaData != nullptr) (void)scene.mMetaData->Get("UnitScaleFactor", factor);
  return (std::isfinite(factor) && factor > 0 ? static_cast<double>(factor) : 1) * centimetre;
}

}  // namespace

auto read_assimp(std::string_view bytes, const std::string& extension) -> formats::outside::Scene {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // it takes ownership
  // Only triangles and polygons matter: no pictures, skins, animations, lights or cameras.
  for (const char* what :
       {AI_CONFIG_IMPORT_FBX_READ_MATERIALS, AI_CONFIG_IMPORT_FBX_READ_TEXTURES, AI_CONFIG_IMPORT_FBX_READ_CAMERAS,
        AI_CONFIG_IMPORT_FBX_READ_LIGHTS, AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, AI_CONFIG_IMPORT_FBX_READ_WEIGHTS})
    importer.SetPropertyBool(what, false);
  const aiScene* from = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (from == nullptr || from->mRootNode == nullptr) throw Wrong(importer.GetErrorString());
  formats::outside::Scene scene;
  scene.nodes.emplace_back();
  AssimpWalk(*from, scene).take(*from->mRootNode, {});
  // The library turns COLLADA to y up and metres, and leaves FBX as it is.
  int axis = 1;  // of 0, 1 and 2
  if (extension == "fbx" && from->mMetaData != nullptr) (void)from->mMetaData->Get("UpAxis", axis);
  scene.y_up = extension == "stl" || axis == 2 ? 0 : 1;
  const double unit = extension == "fbx" ? unit_of(*from) : 1;
  for (auto& mesh : scene.meshes)
    for (auto& v : mesh.vertices)
      for (double& c : v) c *= unit;
  scene.farthest *= unit;
  return scene;
}

}  // namespace mansard::reader
