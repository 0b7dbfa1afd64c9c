#include "ascii_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace mansard::segment::testing {
namespace {

using geometry::Point2;

constexpr std::array<std::pair<int, int>, 4> turn{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};  // east, north, west, south

}  // namespace

auto AsciiMap::at(int column, int row) const -> char {
  const auto height = static_cast<int>(rows.size());
  if (row < 0 || row >= height || column < 0) return '.';
  const std::string& line = rows[static_cast<std::size_t>(height - 1 - row)];
  return column < static_cast<int>(line.size()) ? line[static_cast<std::size_t>(column)] : '.';
}

AsciiMap::AsciiMap(std::vector<std::string> drawing, double cell_size) : rows(std::move(drawing)), cell(cell_size) {
  const auto height = static_cast<int>(rows.size());
  int width = 0;
  for (const auto& line : rows) {
    width = std::max(width, static_cast<int>(line.size()));
    for (const char c : line)
      if (c != '.') face[c] = 0;
  }
  std::uint32_t number = 0;
  for (auto& [letter, f] : face) f = number++;
  arrangement.faces.resize(face.size());

  // Directed unit edges with a letter on the left: those are the half-edges, their twins follow.
  std::map<std::pair<int, int>, std::uint32_t> vertex;
  std::map<std::pair<std::pair<int, int>, int>, std::uint32_t> leaving;  // (corner, direction) → half-edge
  const auto vertex_at = [&](int x, int y) {
    const auto [found, fresh] = vertex.try_emplace({x, y}, static_cast<std::uint32_t>(vertex.size()));
    if (fresh) arrangement.vertices.push_back({cell * x, cell * y});
    return found->second;
  };
  const auto face_of = [&](char c) -> std::optional<std::uint32_t> {
    return c == '.' ? std::nullopt : std::optional(face.at(c));
  };
  const auto add = [&](int x, int y, int direction, char left, char right) {
    const auto [dx, dy] = turn[static_cast<std::size_t>(direction)];
    const auto h = static_cast<std::uint32_t>(arrangement.half_edges.size());
    arrangement.half_edges.push_back({vertex_at(x, y), h + 1, 0, 0, face_of(left), {}});
    arrangement.half_edges.push_back({vertex_at(x + dx, y + dy), h, 0, 0, face_of(right), {}});
    leaving[{{x, y}, direction}] = h;
    leaving[{{x + dx, y + dy}, (direction + 2) % 4}] = h + 1;
  };
  for (int y = 0; y <= height; ++y)
    for (int x = 0; x <= width; ++x) {
      if (at(x, y) != at(x, y - 1)) add(x, y, 0, at(x, y), at(x, y - 1));  // eastwards: north is left
      if (at(x - 1, y) != at(x, y)) add(x, y, 1, at(x - 1, y), at(x, y));  // northwards: west is left
    }
  // The next half-edge of a face turns left as sharply as it can.
  for (const auto& [key, h] : leaving) {
    const auto& [corner, direction] = key;
    const auto [dx, dy] = turn[static_cast<std::size_t>(direction)];
    for (const int change : {1, 0, 3, 2}) {
      const auto found = leaving.find({{corner.first + dx, corner.second + dy}, (direction + change) % 4});
      if (found == leaving.end()) continue;
      arrangement.half_edges[h].next = found->second;
      arrangement.half_edges[found->second].previous = h;
      break;
    }
  }
  for (std::uint32_t h = static_cast<std::uint32_t>(arrangement.half_edges.size()); h-- > 0;)
    if (const auto f = arrangement.half_edges[h].face) arrangement.faces[*f].edge = h;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (at(x, y) != '.') arrangement.faces[face.at(at(x, y))].area += cell * cell;
}

void AsciiMap::wall(Point2 start, Point2 end, std::uint32_t source, fracture::Kind kind) {
  const geometry::Segment2 line{start, end};
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); ++h) {
    const auto s = arrangement.segment(h);
    if (geometry::distance(line, s.start) > 1e-9 || geometry::distance(line, s.end) > 1e-9) continue;
    auto& origins = arrangement.half_edges[h].origins;
    origins.push_back({kind, source, geometry::dot(s.end - s.start, end - start) > 0});
    std::ranges::sort(origins);
  }
}

auto AsciiMap::roofs(const std::map<char, double>& height) const -> geometry::Mesh {
  geometry::Mesh mesh;
  for (int y = 0; y < static_cast<int>(rows.size()); ++y)
    for (int x = 0; x < 1000 && x < static_cast<int>(rows[rows.size() - 1 - static_cast<std::size_t>(y)].size()); ++x) {
      const auto found = height.find(at(x, y));
      if (found == height.end()) continue;
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        mesh.vertices.push_back({cell * (x + dx), cell * (y + dy), found->second});
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  return mesh;
}

auto AsciiMap::block(const std::vector<std::string>& letters_of_feature) const -> block::Block {
  block::Block block;
  block.name = "block-0";
  for (std::size_t feature = 0; feature < letters_of_feature.size(); ++feature) {
    block::Member member;
    member.feature = feature;
    for (int y = 0; y < static_cast<int>(rows.size()); ++y)
      for (int x = 0; x < 1000; ++x) {
        const char c = at(x, y);
        if (c == '.' || letters_of_feature[feature].find(c) == std::string::npos) continue;
        const Point2 p{cell * x, cell * y};
        member.polygons.push_back({{p, p + Point2{cell, 0}, p + Point2{cell, cell}, p + Point2{0, cell}}, {}});
      }
    block.members.push_back(std::move(member));
  }
  return block;
}

auto sweep_edges(std::size_t count) -> sweep::SweepEdges {
  sweep::SweepEdges edges;
  edges.edges.resize(count);
  return edges;
}

}  // namespace mansard::segment::testing
