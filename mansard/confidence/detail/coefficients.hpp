// Written by tools/confidence.py train: change the script, not this file.
// 2026-11-28: 1592 models of 132 simulated surveys, 272 of them wrong.
#pragma once

#include <array>

#include "mansard/confidence/detail/term.hpp"

namespace mansard::confidence::detail {

inline constexpr double wrong_bias = -3.8473, error_bias = -2.3518;
inline constexpr std::array<Term, 30> terms{{
    {Measure::area, alone, 50, 1.1816, 0.6146, 0.2599},
    {Measure::height, alone, 3, 1.5273, -0.5239, -0.0429},
    {Measure::unseen, alone, 0.05, 0.3096, 0.9901, 0.3958},
    {Measure::bare, alone, 0.02, 0.8323, 0.7279, 0.2886},
    {Measure::bias, alone, 0.05, 0.1271, -0.0061, 0.3112},
    {Measure::above, alone, 0.02, 0.0820, 0.8323, 0.4304},
    {Measure::below, alone, 0.02, 0.0815, 0.8897, 0.0000},
    {Measure::patch_below, alone, 1, 0.0772, 0.0000, 0.2268},
    {Measure::rough, alone, 0.02, 0.0648, 0.0777, 0.0000},
    {Measure::ring_high, alone, 0.05, 0.2713, 0.1596, 0.0000},
    {Measure::gap, alone, 0.05, 0.3536, 1.4808, 0.1634},
    {Measure::free, alone, 0.3, 1.0884, -0.5028, 0.2662},
    {Measure::walls, alone, 0.2, 1.0237, 0.5479, 0.3874},
    {Measure::steps, alone, 1, 0.4029, 0.6463, 0.1565},
    {Measure::relief, alone, 0.5, 1.5118, 0.1647, 0.2556},
    {Measure::low, alone, 0.1, 0.1042, 1.7595, 1.1941},
    {Measure::ground_off, alone, 0.2, 0.4106, 0.0000, 0.0063},
    {Measure::samples, alone, 50, 2.2868, 0.3136, 0.0152},
    {Measure::planes, alone, 3, 0.7527, 0.0006, 0.0827},
    {Measure::small_planes, alone, 0.05, 0.0487, 0.0000, 0.1129},
    {Measure::steep, alone, 0.05, 0.3162, 0.2115, 0.0000},
    {Measure::spread, alone, 1, 1.5205, -0.0509, 0.5824},
    {Measure::height_off, alone, 0.5, 0.1781, 1.9326, 0.4911},
    {Measure::fallback, alone, 0.5, 0.0009, 2.4452, 0.7895},
    {Measure::unseen, Measure::spread, 0.2, 0.2969, 0.1208, 0.0627},
    {Measure::gap, Measure::height, 0.3, 0.5160, 0.3839, 0.5027},
    {Measure::steps, Measure::edge_noise, 0.1, 0.3762, 0.7992, 0.4265},
    {Measure::ring_side, Measure::rim_side, 0.05, 0.0085, 1.8565, 0.0394},
    {Measure::relief, Measure::relief, 2, 1.0396, 0.3057, -0.0203},
    {Measure::spread, Measure::free, 0.5, 1.6198, -0.3893, -0.3680},
}};

}  // namespace mansard::confidence::detail
