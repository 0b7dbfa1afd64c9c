// Written by tools/confidence.py train: change the script, not this file.
// 2026-11-28: 1592 models of 132 simulated surveys, 272 of them wrong.
#pragma once

#include <array>

#include "mansard/confidence/evidence.hpp"

namespace mansard::confidence::detail {

struct Term {
  Measure measure;
  Measure second;       ///< by which it is multiplied; `alone` for none
  double scale;         ///< of their units: they count as ln(1 + |x| / scale)
  double usual;         ///< mean of that among the models that were right
  double wrong, error;  ///< weights: logarithm of the odds to be wrong, and of the error in metres
};
inline constexpr auto alone = static_cast<Measure>(measures);
inline constexpr double wrong_bias = -3.6723, error_bias = -2.3306;
inline constexpr std::array<Term, 29> terms{{
    {Measure::area, alone, 50, 1.1816, 0.7636, 0.3003},
    {Measure::height, alone, 3, 1.5273, -1.0110, -0.2491},
    {Measure::unseen, alone, 0.05, 0.3096, 0.9985, 0.3567},
    {Measure::bare, alone, 0.02, 0.8323, 0.5061, 0.2344},
    {Measure::bias, alone, 0.05, 0.1271, -0.1135, 0.3247},
    {Measure::above, alone, 0.02, 0.0820, 0.7695, 0.3635},
    {Measure::below, alone, 0.02, 0.0815, 1.0249, 0.0395},
    {Measure::patch_below, alone, 1, 0.0772, 0.0000, 0.2116},
    {Measure::ring_high, alone, 0.05, 0.2713, 0.0721, 0.0000},
    {Measure::gap, alone, 0.05, 0.3536, 1.2586, 0.0979},
    {Measure::rim_low, alone, 0.05, 0.0683, 0.2167, 0.0000},
    {Measure::free, alone, 0.3, 1.0884, -0.0420, 0.1579},
    {Measure::walls, alone, 0.2, 1.0237, 1.2234, 0.2663},
    {Measure::relief, alone, 0.5, 1.5118, 0.0656, -0.6451},
    {Measure::low, alone, 0.1, 0.1042, 0.9033, 0.8744},
    {Measure::samples, alone, 50, 2.2868, 0.3957, 0.0607},
    {Measure::planes, alone, 3, 0.7527, -0.5283, -0.1208},
    {Measure::small_planes, alone, 0.05, 0.0487, 0.5210, 0.2980},
    {Measure::steep, alone, 0.05, 0.3162, 0.1414, 0.0000},
    {Measure::spread, alone, 1, 1.5205, 0.2349, 0.2106},
    {Measure::height_off, alone, 0.5, 0.1781, 2.0982, 0.6457},
    {Measure::fallback, alone, 0.5, 0.0009, 3.3545, 0.8421},
    {Measure::unseen, Measure::spread, 0.2, 0.2969, 0.1958, 0.1393},
    {Measure::rim_side, Measure::height, 1, 0.1003, 0.0000, 0.0992},
    {Measure::gap, Measure::height, 0.3, 0.5160, 0.5702, 0.5692},
    {Measure::walls, Measure::spread, 0.5, 1.2992, 0.0575, 0.4048},
    {Measure::ring_side, Measure::rim_side, 0.05, 0.0085, 2.0170, 0.1067},
    {Measure::relief, Measure::relief, 2, 1.0396, 1.3218, 0.8580},
    {Measure::spread, Measure::free, 0.5, 1.6198, -0.2785, -0.1412},
}};

}  // namespace mansard::confidence::detail
