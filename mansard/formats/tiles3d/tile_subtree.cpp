#include "mansard/formats/tiles3d/tile_subtree.hpp"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "mansard/base/nesting.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"

namespace mansard::formats {

using PlainJson = nlohmann::json;

namespace {

/// The bits of the indices, taken in turn: x first.
auto morton(const TileIndex& index, bool octree) -> std::uint64_t {
  const std::size_t axes = octree ? 3 : 2;
  std::uint64_t out = 0;
  for (std::size_t bit = 0; bit < index.level; ++bit)
    for (std::size_t axis = 0; axis < axes; ++axis) out |= (index.at[axis] >> bit & 1U) << (bit * axes + axis);
  return out;
}

/// How many tiles there are above a level.
auto before_level(std::uint32_t level, bool octree) -> std::uint64_t {
  const std::uint64_t one = 1;
  return octree ? ((one << (3 * level)) - 1) / 7 : ((one << (2 * level)) - 1) / 3;
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

/// JSON and the binary part after it, or JSON alone.
class SubtreeReader {
 public:
  SubtreeReader(const std::filesystem::path& path, std::vector<model::InputFile>& inputs)
      : path_(path), name_(path.string()), inputs_(inputs) {}

  auto read(std::uint32_t levels, bool octree) -> base::Result<Subtree> {
    if (auto done = load(path_, file_); !done) return done.error();
    if (auto parsed = parse(file_.view()); !parsed) return parsed.error();
    Subtree out;
    out.levels_ = levels;
    out.octree_ = octree;
    const std::uint64_t tiles = before_level(levels, octree);
    const std::uint64_t children = before_level(levels + 1, octree) - tiles;
    if (auto done = take("tileAvailability", tiles, out.tiles_); !done) return done.error();
    if (auto done = take("childSubtreeAvailability", children, out.children_); !done) return done.error();
    const auto contents = json_.find("contentAvailability");
    if (contents == json_.end()) return out;
    // One for each content of a tile; in the extension to 3D Tiles 1.0, one without a list around it.
    const PlainJson list = contents->is_array() ? *contents : PlainJson::array({*contents});
    for (const PlainJson& one : list)
      if (auto done = bits_of(one, tiles, out.contents_.emplace_back()); !done) return done.error();
    return out;
  }

 private:
  [[nodiscard]] auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-mesh-format", "the subtree " + what + "; export the tileset again", name_);
  }

  auto load(const std::filesystem::path& path, Bytes& bytes) -> base::Result<void> {
    auto read = bytes_of_named(path);
    if (!read) return read.error();
    bytes = std::move(*read);
    inputs_.push_back({path.string(), bytes.view().size(), sha256(bytes.view())});
    return {};
  }

  auto parse(std::string_view bytes) -> base::Result<void> {
    std::string_view text = bytes;
    if (bytes.starts_with("subt")) {
      constexpr std::size_t header = 24;
      if (bytes.size() < header) return bad("ends in its header");
      std::uint64_t json = 0, binary = 0;
      std::memcpy(&json, bytes.data() + 8, 8);
      std::memcpy(&binary, bytes.data() + 16, 8);
      if (json > bytes.size() - header || binary > bytes.size() - header - json)
        return base::error("ingest-mesh-truncated", "the subtree ends before what its header promises; copy it again",
                           name_);
      text = bytes.substr(header, json);
      binary_ = bytes.substr(header + json, binary);
    }
    if (base::nests_too_deep(text)) return bad("nests too deep");
    json_ = PlainJson::parse(text, nullptr, false);
    if (!json_.is_object()) return bad("is damaged");
    return {};
  }

  auto take(const char* key, std::uint64_t count, Subtree::Bits& bits) -> base::Result<void> {
    const auto found = json_.find(key);
    if (found == json_.end()) return bad(std::string("has no ") + key);
    return bits_of(*found, count, bits);
  }

  auto bits_of(const PlainJson& object, std::uint64_t count, Subtree::Bits& bits) -> base::Result<void> {
    if (!object.is_object()) return bad("does not say what there is");
    if (object.contains("constant")) {
      bits.all = object["constant"] == 1;
      return {};
    }
    const PlainJson& number =
        object.contains("bitstream") ? object["bitstream"] : object.value("bufferView", PlainJson());
    if (!number.is_number_unsigned()) return bad("does not say what there is");
    const auto bytes = view_of(number.get<std::size_t>());
    if (!bytes) return bytes.error();
    if (bytes->size() < (count + 7) / 8) return bad("has fewer bits than tiles");
    bits.each.resize(count);
    for (std::uint64_t i = 0; i < count; ++i)
      bits.each[i] = (static_cast<unsigned char>((*bytes)[i / 8]) >> (i % 8) & 1) != 0;
    return {};
  }

  auto view_of(std::size_t index) -> base::Result<std::string_view> {
    const auto entry = [&](const char* list, std::size_t i) -> const PlainJson* {
      const auto found = json_.find(list);
      if (found == json_.end() || !found->is_array() || i >= found->size() || !(*found)[i].is_object()) return nullptr;
      return &(*found)[i];
    };
    const auto whole = [](const PlainJson& object, const char* key) -> std::size_t {
      const auto found = object.find(key);
      return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
    };
    const PlainJson* view = entry("bufferViews", index);
    const PlainJson* buffer = view == nullptr ? nullptr : entry("buffers", whole(*view, "buffer"));
    if (buffer == nullptr) return bad("names a buffer that does not exist");
    std::string_view bytes = binary_;
    if (buffer->contains("uri") && (*buffer)["uri"].is_string()) {
      auto& kept = beside_.emplace_back();
      const auto beside = address_beside(path_, (*buffer)["uri"].get<std::string>());
      if (auto reach = check_reach(path_, beside); !reach) return reach.error();
      if (auto done = load(beside, kept); !done) return done.error();
      bytes = kept.view();
    }
    const std::size_t offset = whole(*view, "byteOffset"), size = whole(*view, "byteLength");
    if (offset > bytes.size() || size > bytes.size() - offset) return bad("names bits that reach beyond its buffer");
    return bytes.substr(offset, size);
  }

  const std::filesystem::path& path_;
  const std::string name_;
  std::vector<model::InputFile>& inputs_;
  Bytes file_;
  std::vector<Bytes> beside_;
  std::string_view binary_;
  PlainJson json_;
};

auto part_of(const Volume& root, const TileIndex& index, bool octree) -> Volume {
  const double parts = std::ldexp(1.0, static_cast<int>(index.level));
  const auto share = [&](std::size_t axis) { return static_cast<double>(index.at[axis]) / parts; };
  if (const auto* region = std::get_if<DegreeBox>(&root)) {
    DegreeBox out = *region;
    out.west = region->west + share(0) * (region->east - region->west);
    out.east = out.west + (region->east - region->west) / parts;
    out.south = region->south + share(1) * (region->north - region->south);
    out.north = out.south + (region->north - region->south) / parts;
    return out;
  }
  const auto* box = std::get_if<TileBox>(&root);
  if (box == nullptr) return {};
  TileBox out = *box;
  for (std::size_t axis = 0; axis < (octree ? 3 : 2); ++axis) {
    out.middle = out.middle + (2 * share(axis) + 1 / parts - 1) * box->half[axis];
    out.half[axis] = (1 / parts) * box->half[axis];
  }
  return out;
}

auto filled_in(std::string address, const TileIndex& index) -> std::string {
  replace_all(address, "{level}", std::to_string(index.level));
  replace_all(address, "{x}", std::to_string(index.at[0]));
  replace_all(address, "{y}", std::to_string(index.at[1]));
  replace_all(address, "{z}", std::to_string(index.at[2]));
  return address;
}

auto Subtree::read(const std::filesystem::path& path, std::uint32_t levels, bool octree,
                   std::vector<model::InputFile>& inputs) -> base::Result<Subtree> {
  return SubtreeReader(path, inputs).read(levels, octree);
}

auto Subtree::has_tile(const TileIndex& local) const -> bool {
  if (local.level >= levels_) return children_.at(morton(local, octree_));
  return tiles_.at(before_level(local.level, octree_) + morton(local, octree_));
}

auto Subtree::has_content(std::size_t which, const TileIndex& local) const -> bool {
  return which < contents_.size() && contents_[which].at(before_level(local.level, octree_) + morton(local, octree_));
}

}  // namespace mansard::formats
