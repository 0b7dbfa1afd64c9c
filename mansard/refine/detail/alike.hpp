// Alike what is alike: eaves, ridges and pitches that nearly agree are one value each, within a building and along a
// row of them.
#pragma once

#include <vector>

#include "mansard/refine/detail/work.hpp"

namespace mansard::refine::detail {

/// What must be said of a roof has its price (`Options::value_price`): every height and pitch that differs from all
/// others. Two that are made equal save one. Of all ties of eaves, pitches and ridges that which moves the roofs least
/// is taken first, as long as it moves them by less than the price: first within parts, then between parts that touch,
/// eaves and ridges before pitches. `pieces`: all of one block, of any owners. A piece whose true cost grows by more
/// than that, or of which no solid can be made, stays as it was. Cost: two sketches and a raise a piece, and the square
/// of the ties of parts that touch.
void make_alike(std::vector<Piece>& pieces, const Work& work);

}  // namespace mansard::refine::detail
