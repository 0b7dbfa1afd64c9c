#include "bench/ingest/others.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <tiny_obj_loader.h>
#include <assimp/Importer.hpp>

namespace mansard::bench {

auto read_by_tinyobjloader(const std::string& path) -> std::size_t {
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  if (!reader.ParseFromFile(path, config)) return 0;
  std::size_t triangles = 0;
  for (const auto& shape : reader.GetShapes()) triangles += shape.mesh.num_face_vertices.size();
  return triangles;
}

auto read_by_assimp(const std::string& path) -> std::size_t {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr) return 0;
  std::size_t triangles = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
  return triangles;
}

}  // namespace mansard::bench
