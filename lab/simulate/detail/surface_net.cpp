#include "lab/simulate/detail/surface_net.hpp"

#include <algorithm>
#include <cmath>

#include "lab/simulate/detail/columns.hpp"
#include "mansard/base/stopped.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Point3;
using Key = std::uint64_t;

constexpr std::int64_t side = 64;       // columns of a piece
constexpr std::int64_t bias = 1 << 20;  // levels may be negative

/// A cell by its lowest node; cells of one piece sort next to each other.
auto key_of(std::int64_t i, std::int64_t j, std::int64_t k) -> Key {
  return static_cast<Key>(i) << 42U | static_cast<Key>(j) << 21U | static_cast<Key>(k + bias);
}

struct Piece {
  std::vector<std::pair<Key, Point3>> vertices;  // by key
  std::vector<std::array<Key, 4>> quads;         // counter-clockwise from outside
};

class Net {
 public:
  Net(const World& world, double resolution, double melt)
      : world_(world), deviation_(melt / resolution), lattice_{{}, resolution} {
    // Whole steps, so that a scan does not depend on what lies at the far end of the area.
    const auto whole = [&](double x) { return std::floor(x / resolution) * resolution; };
    lattice_.origin = {whole(world.area.least.x), whole(world.area.least.y), 0};
    const auto nodes = [&](double least, double up_to) {
      return static_cast<std::int64_t>(std::ceil((up_to - least) / resolution)) + 1;
    };
    ni_ = nodes(lattice_.origin.x, world.area.most.x);
    nj_ = nodes(lattice_.origin.y, world.area.most.y);
    columns_ = (ni_ + side - 1) / side;
    rows_ = (nj_ + side - 1) / side;
  }

  auto mesh(const base::Run& run) -> base::Result<geometry::Mesh> {
    sort_into_pieces();
    std::vector<Piece> pieces(static_cast<std::size_t>(columns_ * rows_));
    base::parallel_for(pieces.size(), [&](std::size_t at) {
      if (!run.cancelled()) pieces[at] = piece(static_cast<std::int64_t>(at));
    });
    if (run.cancelled()) return base::stopped();
    return joined(pieces);
  }

 private:
  [[nodiscard]] auto reach() const -> std::int64_t { return blur_reach(deviation_) + 1; }

  void sort_into_pieces() {
    triangles_.resize(static_cast<std::size_t>(columns_ * rows_));
    objects_.resize(triangles_.size());
    const double spare = lattice_.step * static_cast<double>(reach() + 1);
    const auto put = [&](geometry::Box2 box, auto& lists, std::uint32_t what) {
      box = box.grown(spare);
      const double length = lattice_.step * static_cast<double>(side);
      const auto of = [&](double x, double origin, std::int64_t count) {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((x - origin) / length)), 0, count - 1);
      };
      for (auto r = of(box.least.y, lattice_.origin.y, rows_); r <= of(box.most.y, lattice_.origin.y, rows_); ++r)
        for (auto c = of(box.least.x, lattice_.origin.x, columns_); c <= of(box.most.x, lattice_.origin.x, columns_);
             ++c)
          lists[static_cast<std::size_t>(r * columns_ + c)].push_back(what);
    };
    const auto& mesh = world_.surface.mesh;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      geometry::Box2 box;
      for (const auto v : mesh.triangles[t]) box.add(xy(mesh.vertices[v]));
      put(box, triangles_, t);
    }
    for (std::uint32_t o = 0; o < world_.objects.size(); ++o) put(world_.objects[o].bounds(), objects_, o);
  }

  [[nodiscard]] auto piece(std::int64_t at) const -> Piece {
    const std::int64_t i0 = at % columns_ * side, j0 = at / columns_ * side;
    const std::int64_t i1 = std::min(i0 + side, ni_ - 1), j1 = std::min(j0 + side, nj_ - 1);
    // The blur looks `halo` nodes further than the nodes whose values are used: i0 … i1 and j0 … j1.
    const std::int64_t halo = reach();
    auto cells = solid_share(world_, lattice_, i0 - halo, j0 - halo, i1 - i0 + 1 + 2 * halo, j1 - j0 + 1 + 2 * halo,
                             halo, triangles_[static_cast<std::size_t>(at)], objects_[static_cast<std::size_t>(at)]);
    blur(cells, deviation_);
    Piece out;
    for (auto i = i0; i < i1; ++i)
      for (auto j = j0; j < j1; ++j)
        for (auto k = cells.k0; k + 1 < cells.k0 + cells.nk; ++k) {
          add_vertex(cells, i, j, k, out);
          add_quads(cells, i, j, k, out);
        }
    return out;
  }

  static auto solid(float share) -> bool { return share > 0.5F; }

  void add_vertex(const Cells& cells, std::int64_t i, std::int64_t j, std::int64_t k, Piece& out) const {
    std::array<float, 8> values{};
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      values[static_cast<std::size_t>(c)] = cells.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
      inside += solid(values[static_cast<std::size_t>(c)]) ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    Point3 sum;
    double count = 0;
    for (int c = 0; c < 8; ++c)
      for (int axis = 0; axis < 3; ++axis) {
        const int d = c | 1 << axis;
        const float a = values[static_cast<std::size_t>(c)], b = values[static_cast<std::size_t>(d)];
        if (d == c || solid(a) == solid(b)) continue;
        const double t = (0.5 - static_cast<double>(a)) / (static_cast<double>(b) - static_cast<double>(a));
        sum = sum + Point3{(c & 1) + (axis == 0 ? t : 0), (c >> 1 & 1) + (axis == 1 ? t : 0),
                           (c >> 2 & 1) + (axis == 2 ? t : 0)};
        ++count;
      }
    out.vertices.emplace_back(key_of(i, j, k), lattice_.at(i, j, k) + (lattice_.step / count) * sum);
  }

  static void add_quads(const Cells& cells, std::int64_t i, std::int64_t j, std::int64_t k, Piece& out) {
    const bool here = solid(cells.at(i, j, k));
    const auto add = [&](bool there, const std::array<Key, 4>& around) {
      if (here == there) return;
      out.quads.push_back(here ? around : std::array<Key, 4>{around[0], around[3], around[2], around[1]});
    };
    const bool low = k == cells.k0;
    if (j > 0 && !low)
      add(solid(cells.at(i + 1, j, k)),
          {key_of(i, j - 1, k - 1), key_of(i, j, k - 1), key_of(i, j, k), key_of(i, j - 1, k)});
    if (i > 0 && !low)
      add(solid(cells.at(i, j + 1, k)),
          {key_of(i - 1, j, k - 1), key_of(i - 1, j, k), key_of(i, j, k), key_of(i, j, k - 1)});
    if (i > 0 && j > 0)
      add(solid(cells.at(i, j, k + 1)),
          {key_of(i - 1, j - 1, k), key_of(i, j - 1, k), key_of(i, j, k), key_of(i - 1, j, k)});
  }

  /// The pieces one after the other; corners are found by their cells.
  [[nodiscard]] auto joined(std::vector<Piece>& pieces) const -> geometry::Mesh {
    geometry::Mesh mesh;
    std::vector<std::uint32_t> first;
    for (const auto& piece : pieces) {
      first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      for (const auto& [key, place] : piece.vertices) mesh.vertices.push_back(place);
    }
    const auto vertex = [&](Key key) -> std::uint32_t {
      const auto i = static_cast<std::int64_t>(key >> 42U), j = static_cast<std::int64_t>(key >> 21U & 0x1fffff);
      const auto at = static_cast<std::size_t>(j / side * columns_ + i / side);
      const auto& vertices = pieces[at].vertices;
      const auto found = std::ranges::lower_bound(vertices, key, {}, &std::pair<Key, Point3>::first);
      return first[at] + static_cast<std::uint32_t>(found - vertices.begin());
    };
    for (const auto& piece : pieces)
      for (const auto& quad : piece.quads) {
        std::array<std::uint32_t, 4> v{};
        std::ranges::transform(quad, v.begin(), vertex);
        const auto diagonal = [&](std::size_t a, std::size_t b) {
          return length(mesh.vertices[v[a]] - mesh.vertices[v[b]]);
        };
        const bool first_way = diagonal(0, 2) <= diagonal(1, 3);
        mesh.triangles.push_back(first_way ? geometry::Triangle{v[0], v[1], v[2]}
                                           : geometry::Triangle{v[0], v[1], v[3]});
        mesh.triangles.push_back(first_way ? geometry::Triangle{v[0], v[2], v[3]}
                                           : geometry::Triangle{v[1], v[2], v[3]});
      }
    return mesh;
  }

  const World& world_;
  double deviation_;
  Lattice lattice_;
  std::int64_t ni_ = 0, nj_ = 0, columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> triangles_, objects_;  // per piece
};

}  // namespace

auto surface_net(const World& world, double resolution, double melt, const base::Run& run)
    -> base::Result<geometry::Mesh> {
  return Net(world, resolution, melt).mesh(run);
}

}  // namespace mansard::simulate::detail
