// Models made of several pieces.
#pragma once

#include <utility>

#include "mansard/model/solid.hpp"

namespace mansard::model {

/// Adds the faces of one model to another; no vertices become one.
inline void append(const LabelledSolid& more, LabelledSolid& to) {
  const auto first = static_cast<std::uint32_t>(to.solid.vertices.size());
  to.solid.vertices.insert(to.solid.vertices.end(), more.solid.vertices.begin(), more.solid.vertices.end());
  for (Face face : more.solid.faces) {
    for (auto& loop : face.loops)
      for (auto& v : loop) v += first;
    to.solid.faces.push_back(std::move(face));
  }
  to.classes.insert(to.classes.end(), more.classes.begin(), more.classes.end());
}

}  // namespace mansard::model
