// What was made of a block in its own frame, put where the block lies in the scene.
#pragma once

#include "mansard/block/block.hpp"
#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// Moves by whole metres. A plan is rounded to 2⁻³⁰ m first: such numbers can be moved without another rounding.
void move(model::Plan& plan, geometry::Point3 by);
void move(model::Solid& solid, geometry::Point3 by);

/// Moves coordinates by the frame's origin and gives features their numbers in the scene; parts are ordered by these.
void place(report::SegmentedBlock& block, const block::OwnFrame& frame);
void place(BlockResult& result, const block::OwnFrame& frame);

}  // namespace mansard::pipeline::detail
