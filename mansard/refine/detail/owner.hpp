// The parts of one owner, joined and cut until that no longer pays.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/refine/refine.hpp"

namespace mansard::refine::detail {

/// `mine`: indices into the drafts, ascending.
[[nodiscard]] auto refine_owner(std::span<const Draft> drafts, std::span<const std::size_t> mine,
                                const rays::Scene& mesh, const Options& options, const extrude::Options& raising,
                                const base::Run& run) -> Refined;

}  // namespace mansard::refine::detail
