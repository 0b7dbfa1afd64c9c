#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/triangles.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point3;
using model::LabelledSolid;
using model::Solid;

template <class T>
void append_little_endian(std::string& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}

void append_point(std::string& bytes, Point3 p) {
  for (const double v : {p.x, p.y, p.z})
    append_little_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(v)));
}

/// What single precision makes of it.
auto rounded(Point3 p) -> Point3 {
  return {static_cast<double>(static_cast<float>(p.x)), static_cast<double>(static_cast<float>(p.y)),
          static_cast<double>(static_cast<float>(p.z))};
}

/// 80 bytes that do not begin with "solid", by which programs tell STL as text: what to add to come to the file frame.
auto stl_header(const model::Frame& frame) -> std::string {
  std::string text = "mansard; metres, z up; add";
  for (const auto metres : frame.origin) text += " " + std::to_string(metres);
  if (frame.crs.starts_with("EPSG:")) text += " for " + frame.crs;
  text.resize(80, ' ');
  return text;
}

class StlWriter : public CityWriter {
 public:
  StlWriter(Shell shell, LevelOf level, const model::Frame& frame, std::unique_ptr<base::Spool> triangles,
            base::Sink& file)
      : shell_(shell),
        level_(level),
        frame_(frame),
        header_(stl_header(frame)),
        triangles_(std::move(triangles)),
        file_(file) {}

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    if (shell_ == Shell::block) {
      for (const model::Part& part : building.parts)
        if (!part.model.solid.faces.empty()) parts_.push_back({part.model, building.id});
      return {};
    }
    Drawn all = drawn(building, *keyed, shell_ == Shell::part ? Solids::part : Solids::building);
    level_.apply(all, frame_);
    warnings_.insert(warnings_.end(), all.warnings.begin(), all.warnings.end());
    for (const auto& [part, parts] : all.solids)
      if (auto put = append(part.model.solid, part.id); !put) return put;
    return {};
  }

  auto finish() -> base::Result<void> override {
    if (auto put = append_blocks(); !put) return put;
    constexpr std::uint64_t most = UINT32_MAX;
    if (count_ > most)
      return base::error("write-stl-size", "there are " + std::to_string(count_) +
                                               " triangles, more than an STL can count; run smaller areas (--bbox)");
    append_little_endian(header_, static_cast<std::uint32_t>(count_));
    file_.append(header_);
    return triangles_->copy_to(file_);
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return warnings_; }

 private:
  struct Placed {
    LabelledSolid model;
    std::string building;
  };

  /// Parts whose boxes meet belong to one block.
  auto append_blocks() -> base::Result<void> {
    std::vector<geometry::Box2> boxes(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (const auto v : parts_[p].model.solid.vertices) boxes[p].add(geometry::xy(v));
    base::DisjointSets sets(parts_.size());
    constexpr double near = 2e-3;                           // m
    std::vector<std::uint32_t> order(parts_.size()), open;  // those that reach as far as the next begins
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {}, [&](std::uint32_t p) { return std::pair(boxes[p].least.x, p); });
    for (const std::uint32_t p : order) {
      std::erase_if(open, [&](std::uint32_t q) { return boxes[q].most.x + near < boxes[p].least.x; });
      for (const std::uint32_t q : open)
        if (boxes[q].grown(near).overlaps(boxes[p])) sets.join(std::max(p, q), std::min(p, q));
      open.push_back(p);
    }
    std::map<std::uint32_t, std::vector<std::size_t>> blocks;
    for (std::uint32_t p = 0; p < parts_.size(); ++p) blocks[sets.of(p)].push_back(p);
    for (const auto& [name, block] : blocks) {
      std::vector<const LabelledSolid*> models;
      for (const std::size_t p : block) models.push_back(&parts_[p].model);
      auto united = solid::unite(models);
      const auto& building = parts_[block.front()].building;
      for (auto& warning : united.warnings) {
        warning.subject = building;
        warnings_.push_back(std::move(warning));
      }
      for (const auto& one : united.solids)
        if (auto put = append(one.model.solid, building); !put) return put;
    }
    parts_.clear();
    return {};
  }

  /// Cut as its corners are in the file: what is a hair outside of a face in full precision may be inside in single.
  auto append(Solid solid, const std::string& name) -> base::Result<void> {
    for (auto& v : solid.vertices) v = rounded(v);
    const auto cut = triangles_of(solid, name);
    if (!cut) return cut.error();
    std::string bytes;
    for (const auto& corners : cut->triangles) {
      const Point3 a = solid.vertices[corners[0]], b = solid.vertices[corners[1]], c = solid.vertices[corners[2]];
      if (a == b || b == c || c == a) continue;  // its other two edges are one now, so nothing opens
      append_point(bytes, geometry::normalised(cross(b - a, c - a)));
      for (const Point3& p : {a, b, c}) append_point(bytes, p);
      bytes.append(2, '\0');
      ++count_;
    }
    triangles_->append(bytes);
    return {};
  }

  const Shell shell_;
  const LevelOf level_;
  const model::Frame frame_;
  std::string header_;
  std::unique_ptr<base::Spool> triangles_;  ///< their number comes first in the file
  base::Sink& file_;
  Gate gate_;
  std::uint64_t count_ = 0;
  std::vector<Placed> parts_;  ///< of blocks
  std::vector<base::Diagnostic> warnings_;
};

}  // namespace

auto stl_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  const auto level = LevelOf::of(options, Format::stl);
  if (!level) return level.error();
  if (options.stl_shell == Shell::block && level->lod != Lod::lod22)
    return base::error("option-value",
                       "shells of blocks are made of LoD 2.2 only; leave out the level of detail of STL", "write.lod");
  auto spool = base::Spool::open();
  if (!spool) return spool.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<StlWriter>(options.stl_shell, *level, header.frame, std::move(*spool), **file));
}

}  // namespace mansard::formats::detail
