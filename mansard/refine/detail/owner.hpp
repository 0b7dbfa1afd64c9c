// The parts of one owner, joined and cut until that no longer pays.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/refine/detail/work.hpp"
#include "mansard/refine/refine.hpp"

namespace mansard::refine::detail {

struct Roofed {
  std::vector<Piece> pieces;
  Refined rest;  ///< drafts that could not be raised in full, and those that could not be raised at all
  SearchWork search;
};

/// `mine`: indices into the drafts, ascending.
[[nodiscard]] auto refine_owner(std::span<const Draft> drafts, std::span<const std::size_t> mine, const Work& work)
    -> Roofed;

}  // namespace mansard::refine::detail
