#include "mansard/formats/context_capture/context_capture.hpp"

#include <cpl_minixml.h>
#include <array>
#include <memory>
#include <string>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/hash.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

struct Destroyed {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, Destroyed>;

auto without_blanks_around(const std::string& words) -> std::string {
  const auto first = words.find_first_not_of(" \t\r\n");
  return first == words.npos ? std::string() : words.substr(first, words.find_last_not_of(" \t\r\n") + 1 - first);
}

auto numbers_of(const std::string& words) -> std::optional<geometry::Point3> {
  std::array<double, 3> numbers{};
  std::size_t from = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto comma = words.find(',', from);
    if ((comma == words.npos) != (i == 2)) return std::nullopt;
    const auto number = crs::number_of(std::string_view(words).substr(from, comma - from));
    if (!number) return std::nullopt;
    numbers[i] = *number;
    from = comma + 1;
  }
  return geometry::Point3{numbers[0], numbers[1], numbers[2]};
}

auto read(const fs::path& path) -> base::Result<std::optional<Georeference>> {
  const std::string name = path.string();
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.error();
  const std::string text(bytes->view());
  if (text.find("<ModelMetadata") == text.npos) return std::optional<Georeference>();
  const auto bad = [&name](const std::string& what) {
    return base::error("ingest-mesh-metadata",
                       what + "; correct the file, or say --crs local to take the mesh's coordinates as they are",
                       name);
  };
  const crs::GdalMessages messages;
  const Xml xml(CPLParseXMLString(text.c_str()));
  const CPLXMLNode* root = xml ? CPLGetXMLNode(xml.get(), "=ModelMetadata") : nullptr;
  if (root == nullptr) return bad("it is not XML (" + messages.failure() + ")");
  const auto system = without_blanks_around(CPLGetXMLValue(root, "SRS", ""));
  if (system.empty()) return std::optional<Georeference>();  // the program knew no place either
  auto crs = crs::mesh_crs(system);
  if (!crs)
    return bad("its <SRS> '" + system.substr(0, 60) + (system.size() > 60 ? "…" : "") +
               "' is not a projected CRS, EPSG:4978 or ENU:latitude,longitude");
  const auto origin = without_blanks_around(CPLGetXMLValue(root, "SRSOrigin", "0,0,0"));
  const auto numbers = numbers_of(origin);
  if (!numbers) return bad("its <SRSOrigin> '" + origin.substr(0, 60) + "' is not three numbers with commas");
  crs->origin = *numbers;
  return std::optional(Georeference{std::move(*crs), {name, text.size(), sha256(text)}});
}

}  // namespace

auto georeference_of(const fs::path& folder) -> base::Result<std::optional<Georeference>> {
  if (is_virtual(folder)) {
    const auto path = folder / "metadata.xml";
    return is_there(path) ? read(path) : std::optional<Georeference>();
  }
  std::error_code failure;
  fs::path at = fs::absolute(folder, failure);
  if (!at.has_filename()) at = at.parent_path();
  for (int levels = 0; levels < 3; ++levels, at = at.parent_path())
    if (const auto path = at / "metadata.xml"; fs::is_regular_file(path, failure)) return read(path);
  return std::optional<Georeference>();
}

}  // namespace mansard::formats
