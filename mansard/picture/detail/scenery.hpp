// What is drawn, in pieces of which one at a time is ready for rays.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mansard/picture/detail/camera.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::picture::detail {

/// All layers of a piece as one mesh.
class Piece {
 public:
  /// What a point of a triangle looks like.
  struct Look {
    Colour colour{};
    bool pictured = false;  ///< the colour is that of a picture
  };

  /// The layers must outlive it.
  explicit Piece(std::span<const Layer> layers);
  /// The same with layers of its own.
  explicit Piece(std::vector<Layer> layers);

  [[nodiscard]] auto scene() const -> const rays::Scene& { return *scene_; }
  /// Unit, either side; zero for one without area.
  [[nodiscard]] auto normal(std::size_t triangle) const -> geometry::Point3 { return normals_[triangle]; }
  [[nodiscard]] auto look(std::size_t triangle, geometry::Point3 point) const -> Look;

 private:
  void join(std::span<const Layer> layers);

  std::vector<Layer> own_;
  /// The layers with pictures: their first triangle, how many they have, and what gives the colours.
  struct Pictured {
    std::size_t first = 0, count = 0;
    const Layer* layer = nullptr;
  };
  std::vector<Pictured> pictured_;
  std::vector<geometry::Point3> normals_;
  std::vector<Colour> colours_;
  std::unique_ptr<const rays::Scene> scene_;
};

class Scenery {
 public:
  /// One piece that stays in memory; the layers must outlive it.
  explicit Scenery(std::span<const Layer> layers) : layers_(layers), count_(1) {}
  explicit Scenery(const Pieces& pieces) : pieces_(&pieces), count_(pieces.count) {}

  /// Goes through all pieces once, and once more for the paper. `views` have the directions of the cameras. Fails as
  /// Pieces::load does.
  [[nodiscard]] auto survey(std::span<const Camera> views) -> base::Result<void>;

  // After that:
  [[nodiscard]] auto size() const -> std::size_t { return count_; }
  /// Of the vertices that triangles have.
  [[nodiscard]] auto box(std::size_t piece) const -> const geometry::Box3& { return boxes_[piece]; }
  [[nodiscard]] auto box() const -> const geometry::Box3& { return box_; }
  /// By the directions of a view.
  [[nodiscard]] auto box_in(std::size_t view) const -> const geometry::Box3& { return in_views_[view]; }
  /// Below all but the lowest hundredth of the vertices.
  [[nodiscard]] auto low() const -> double { return low_; }
  [[nodiscard]] auto piece(std::size_t number) const -> base::Result<std::shared_ptr<const Piece>>;

 private:
  /// visit(piece's number, its layers) for all.
  template <class Visit>
  [[nodiscard]] auto each(Visit visit) const -> base::Result<void>;

  std::span<const Layer> layers_;
  const Pieces* pieces_ = nullptr;  ///< none where all is in memory
  std::size_t count_;
  std::vector<geometry::Box3> boxes_;
  geometry::Box3 box_;
  std::vector<geometry::Box3> in_views_;
  double low_ = 0;
  mutable std::shared_ptr<const Piece> only_;  ///< the only one stays
};

}  // namespace mansard::picture::detail
