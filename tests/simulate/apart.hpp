// Simulated buildings beside each other.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/city.hpp"

namespace simulated {

/// No two footprints have ground in common.
inline void expect_apart(const std::vector<mansard::model::Building>& buildings) {
  namespace geometry = mansard::geometry;
  for (std::size_t a = 0; a < buildings.size(); ++a)
    for (std::size_t b = a + 1; b < buildings.size(); ++b)
      for (const auto& p : buildings[a].footprint)
        for (const auto& q : buildings[b].footprint) {
          const auto common = geometry::intersect(p, q);
          ASSERT_TRUE(common);
          double shared = 0;
          for (const auto& piece : *common) shared += geometry::area(piece);
          EXPECT_LT(shared, 0.01) << buildings[a].id << " " << buildings[b].id;
        }
}

}  // namespace simulated
