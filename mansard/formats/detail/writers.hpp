// The writers and readers behind stream.hpp, one per format.
#pragma once

#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

using WriterResult = base::Result<std::unique_ptr<CityWriter>>;
using ReaderResult = base::Result<std::unique_ptr<CityReader>>;
using Path = std::filesystem::path;

[[nodiscard]] auto cityjson_writer(const Path& path, const Header& header, const WriteOptions& options,
                                   base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto cityjsonseq_writer(const Path& path, const Header& header, const WriteOptions& options,
                                      base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto obj_writer(const Path& path, const Header& header, const WriteOptions& options,
                              base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto plans_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto glb_writer(const Path& path, const Header& header, const WriteOptions& options,
                              base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto tiles_writer(const Path& folder, const Header& header, const WriteOptions& options,
                                base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto geopackage_writer(const Path& path, const Header& header, const WriteOptions& options,
                                     const std::vector<Layer>& more, base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto citygml_writer(const Path& path, const Header& header, const WriteOptions& options,
                                  base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto dxf_writer(const Path& path, const Header& header, const WriteOptions& options,
                              base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto flatgeobuf_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto stl_writer(const Path& path, const Header& header, const WriteOptions& options,
                              base::Outputs& outputs) -> WriterResult;
[[nodiscard]] auto geojson_writer(const Path& path, const Header& header, base::Outputs& outputs) -> WriterResult;

/// What of a file has models.
enum class Models : std::uint8_t { none, of_parts, of_buildings };

/// CityJSON and CityJSONSeq, with models.
[[nodiscard]] auto cityjson_reader(const Path& path) -> ReaderResult;
[[nodiscard]] auto plans_reader(const Path& path) -> ReaderResult;
/// The buildings of a city that was read as a whole, one after the other; `refused` are the parts that it lacks.
[[nodiscard]] auto whole_reader(model::City city, Models models, std::vector<base::Diagnostic> refused = {})
    -> std::unique_ptr<CityReader>;
[[nodiscard]] auto obj_reader(const Path& path) -> ReaderResult;
[[nodiscard]] auto glb_reader(const Path& path) -> ReaderResult;
[[nodiscard]] auto tiles_reader(const Path& folder) -> ReaderResult;
[[nodiscard]] auto geopackage_reader(const Path& path) -> ReaderResult;
[[nodiscard]] auto geojson_reader(const Path& path) -> ReaderResult;

/// Holds the keys of buildings and parts apart as they come, as keys_of() does for a whole city; and the models against
/// what check_models() asks. Every writer asks one of these first.
class Gate {
 public:
  struct Keyed {
    std::string building;
    std::vector<std::string> parts;
  };
  /// Fails with "write-duplicate-id", "write-model".
  [[nodiscard]] auto admit(const model::Building& building) -> base::Result<Keyed>;

 private:
  struct Taken;
  std::shared_ptr<Taken> taken_;
};

}  // namespace mansard::formats::detail
