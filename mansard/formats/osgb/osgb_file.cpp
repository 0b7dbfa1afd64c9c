#include "mansard/formats/osgb/osgb_file.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/outside/process.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

class Tree {
 public:
  Tree(const fs::path& root, bool textured) : root_(root), textured_(textured) {
    visited_.insert(root.lexically_normal());
  }

  auto take_file(std::string_view bytes, const fs::path& path) -> base::Result<void> {
    auto scene = read_outside("osgb", bytes, path);
    if (!scene) return scene.error();
    const Source source{path, std::move(*scene), static_cast<std::uint32_t>(out.mesh.materials.size())};
    if (textured_)
      for (const auto& picture : source.scene.pictures) out.mesh.materials.push_back(material_of(picture, path));
    return take(source, 0);
  }

  Osgb out;

 private:
  struct Source {
    fs::path path;
    outside::Scene scene;
    std::uint32_t first_material = 0;
  };

  /// The children of the finest level that is complete: in this file, or in files of their own.
  auto take(const Source& source, std::uint32_t number) -> base::Result<void> {
    const auto& node = source.scene.nodes[number];
    for (const auto mesh : node.meshes) take(source, source.scene.meshes[mesh]);
    std::map<float, std::vector<const outside::Node::Child*>> levels;
    for (const auto& child : node.children) levels[child.rank].push_back(&child);
    for (const auto& [rank, children] : levels) {
      std::vector<std::pair<fs::path, Bytes>> read;
      bool complete = true;
      for (const auto* child : children) {
        if (child->file.empty()) continue;
        auto file = open_below(source.path, child->file);
        if (!file) return file.failure();
        complete = complete && file->has_value();
        if (*file) read.push_back(std::move(**file));
      }
      if (!complete) continue;
      for (const auto* child : children)
        if (child->file.empty())
          if (auto done = take(source, child->node); !done) return done;
      for (const auto& [path, bytes] : read) {
        out.inputs.push_back({path.string(), bytes.view().size(), sha256(bytes.view())});
        if (auto done = take_file(bytes.view(), path); !done) return done;
      }
      return {};
    }
    return {};
  }

  /// A file that another refers to; none where it is not there, which is a warning.
  auto open_below(const fs::path& from, const std::string& name)
      -> base::Result<std::optional<std::pair<fs::path, Bytes>>> {
    using Opened = std::optional<std::pair<fs::path, Bytes>>;
    std::string portable = name;
    std::ranges::replace(portable, '\\', '/');
    const fs::path path = from.parent_path() / portable;  // as it is: "/vsizip//tmp" is not "/vsizip/tmp"
    const auto missing = [&](const std::string& why) {
      out.mesh.warnings.push_back(
          base::warning("ingest-mesh-level", why + "; the coarser level is taken", path.string()));
      return Opened();
    };
    if (!check_reach(root_, path)) return missing("the file is outside the folder of the mesh");
    if (!visited_.insert(path.lexically_normal()).second)
      return base::error("ingest-mesh-format", "it refers to a file twice through its levels; export it again",
                         from.string());
    auto bytes = bytes_of_named(path);
    if (bytes) return Opened(std::pair(path, std::move(*bytes)));
    if (bytes.error().code == "file-missing") return missing("the file of a finer level is missing");
    return bytes.failure();
  }

  void take(const Source& source, const outside::Mesh& part) {
    auto& mesh = out.mesh.mesh;
    const auto first = static_cast<std::int64_t>(mesh.vertices.size());
    for (const auto& [x, y, z] : part.vertices) mesh.vertices.push_back({x, y, z});
    for (const auto& triangle : part.triangles) {
      auto& corners = mesh.triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = triangle[c] < part.vertices.size() ? to_index(first + triangle[c]) : no_vertex;
      if (textured_) paint(source, part, triangle);
    }
  }

  void paint(const Source& source, const outside::Mesh& part, const std::array<std::uint32_t, 3>& triangle) {
    const bool pictured = part.picture >= 0 && !part.uv.empty();
    TexturedCorners corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = triangle[c];
      if (pictured && v < part.uv.size()) corners.uv[c] = {part.uv[v][0], 1 - part.uv[v][1]};
      const std::size_t k = part.colours.size() == 1 ? 0 : v;
      if (k < part.colours.size())
        for (std::size_t i = 0; i < 3; ++i) corners.colour[c][i] = linear_of(part.colours[k][i]);
    }
    out.mesh.corners.push_back(corners);
    out.mesh.material_of.push_back(pictured ? source.first_material + static_cast<std::uint32_t>(part.picture)
                                            : no_material);
  }

  auto material_of(const outside::Picture& picture, const fs::path& path) const -> TextureMaterial {
    TextureMaterial material;
    if (picture.bytes.empty()) material.image = ImageSource::beside(root_, path, picture.file);
    else
      material.image = {path, std::make_shared<const std::string>(picture.bytes),
                        path.string() + " image " + base::on_one_line(picture.file)};
    for (std::size_t side = 0; side < 2; ++side)
      material.wrap[side] = picture.wrap[side] == 0   ? Wrap::repeat
                            : picture.wrap[side] == 2 ? Wrap::mirror
                                                      : Wrap::clamp;
    return material;
  }

  const fs::path root_;
  const bool textured_;
  std::set<fs::path> visited_;
};

}  // namespace

auto read_osgb(std::string_view bytes, const fs::path& path, bool textured) -> base::Result<Osgb> {
  Tree tree(path, textured);
  if (auto done = tree.take_file(bytes, path); !done) return done.failure();
  return std::move(tree.out);
}

auto tile_of_level(const fs::path& path) -> fs::path {
  // ContextCapture and DJI Terra: Tile_+001_+002_L20_00130.osgb; the tile itself is Tile_+001_+002.osgb.
  const std::string stem = path.stem().string();
  const auto at = stem.rfind("_L");
  if (at == std::string::npos || at == 0) return {};
  const std::string_view level = std::string_view(stem).substr(at + 2);
  const auto digits = level.substr(0, level.find_first_not_of("0123456789"));
  if (digits.empty() || (digits.size() < level.size() && level[digits.size()] != '_')) return {};
  return path.parent_path() / (stem.substr(0, at) + path.extension().string());
}

}  // namespace mansard::formats
