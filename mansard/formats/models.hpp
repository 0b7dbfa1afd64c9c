// One reader per model format, from the bytes of a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::formats {

/// A model as its file has it: file coordinates, which may be not finite; faces that do not say what they are have
/// `by_normal` set; buildings, parts and faces may be empty.
struct RawModel {
  std::vector<model::ModelBuilding> buildings;
  std::string crs;  ///< as the file spells it; empty for none
  std::string lod;
  std::vector<base::Diagnostic> warnings;
};

/// CityJSON 1.0 to 2.0, as one document or as CityJSONSeq. Fails with "ingest-model-format", "ingest-model-lod".
[[nodiscard]] auto read_cityjson(std::string_view bytes, const std::string& lod, const std::string& name)
    -> base::Result<RawModel>;

/// OBJ whose objects, groups or materials say what is what. Fails with "ingest-model-format".
[[nodiscard]] auto read_labelled_obj(std::string_view bytes, const std::string& name) -> base::Result<RawModel>;

/// Whether groups or materials of an OBJ name the class of every face. Memory: a line; it ends at the first face
/// without one. False where the file cannot be read.
[[nodiscard]] auto labels_every_face(const std::filesystem::path& obj) -> bool;

}  // namespace mansard::formats
