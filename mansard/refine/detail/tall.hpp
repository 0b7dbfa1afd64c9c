// Parts that are taller than they are wide, and whether the mesh shows their walls.
#pragma once

#include "mansard/rays/rays.hpp"
#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// Places on the walls of a part, where these rise clearly from what is next to them, and those of them that the mesh
/// is near to.
struct Walls {
  std::size_t asked = 0, seen = 0;
};
/// `mesh`: without the crowns of trees; where a crown hides what is next to a wall, nothing is asked.
[[nodiscard]] auto walls_of(const Site& site, const View& view, const rays::Scene& mesh, const Options& options)
    -> Walls;

/// Whether a part is taller than `tall_ratio` times the root of its area, and too little of its walls is seen: a tree,
/// a crane or a blade of noise rather than a tower.
[[nodiscard]] auto is_needle(const Site& site, const Judged& roof, const rays::Scene& mesh, const Options& options)
    -> bool;

}  // namespace mansard::refine::detail
