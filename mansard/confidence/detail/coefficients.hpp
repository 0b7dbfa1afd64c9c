// Written by tools/confidence.py train: change the script, not this file.
// 2026-11-29: 1592 models of 132 simulated surveys, 294 of them wrong.
#pragma once

#include <array>

#include "mansard/confidence/detail/term.hpp"

namespace mansard::confidence::detail {

inline constexpr double wrong_bias = -3.5470, error_bias = -2.3401;
inline constexpr std::array<Term, 34> terms{{
    {Measure::area, alone, 50, 1.1829, 0.0551, 0.0292},
    {Measure::height, alone, 3, 1.5248, -0.5173, -0.1203},
    {Measure::unseen, alone, 0.05, 0.2870, 0.0000, 0.0085},
    {Measure::bare, alone, 0.02, 0.6324, 0.9427, 0.2943},
    {Measure::razed, alone, 0.05, 0.1059, 1.3262, 0.8191},
    {Measure::bias, alone, 0.05, 0.1288, 0.0000, 0.2819},
    {Measure::above, alone, 0.02, 0.0883, 0.0000, 0.0699},
    {Measure::below, alone, 0.02, 0.0873, 0.2702, 0.0299},
    {Measure::patch_above, alone, 1, 0.0906, 0.2720, 0.2764},
    {Measure::patch_below, alone, 1, 0.0812, 0.9897, 0.2510},
    {Measure::rough, alone, 0.02, 0.0662, 0.1496, 0.0000},
    {Measure::gap, alone, 0.05, 0.4462, 1.3213, 0.1738},
    {Measure::free, alone, 0.3, 1.0881, 0.3136, 0.3449},
    {Measure::walls, alone, 0.2, 1.0149, 0.4089, 0.2124},
    {Measure::steps, alone, 1, 0.3873, 0.6777, 0.2253},
    {Measure::misplaced, alone, 0.05, 0.4225, 0.4137, 0.0712},
    {Measure::relief, alone, 0.5, 1.4844, 0.2018, 0.4362},
    {Measure::low, alone, 0.1, 0.0404, 0.0000, 0.5097},
    {Measure::samples, alone, 50, 2.3566, 0.2076, -0.0397},
    {Measure::planes, alone, 3, 0.7501, -0.1046, 0.2292},
    {Measure::small_planes, alone, 0.05, 0.0456, 0.9574, 0.4208},
    {Measure::steep, alone, 0.05, 0.3281, 0.0959, 0.0000},
    {Measure::spread, alone, 1, 1.5104, -0.0546, 0.5243},
    {Measure::height_off, alone, 0.5, 0.1685, 0.0000, 0.4776},
    {Measure::fallback, alone, 0.5, 0.0008, 2.2450, 1.6327},
    {Measure::unseen, Measure::unseen, 0.05, 0.0621, 1.4457, 0.5602},
    {Measure::seamless, Measure::seamless, 0.1, 0.0575, 1.7252, 0.8816},
    {Measure::unseen, Measure::spread, 0.2, 0.2755, 0.0719, 0.0446},
    {Measure::height_off, Measure::height_off, 2, 0.0270, 2.8187, 0.0000},
    {Measure::gap, Measure::height, 0.3, 0.6444, 0.0000, 0.1409},
    {Measure::steps, Measure::edge_noise, 0.1, 0.3655, 0.3507, 0.2507},
    {Measure::ring_side, Measure::rim_side, 0.05, 0.0110, 1.1464, 0.0000},
    {Measure::relief, Measure::relief, 2, 0.9993, 0.5088, 0.0176},
    {Measure::spread, Measure::free, 0.5, 1.6092, -0.4648, -0.3899},
}};

}  // namespace mansard::confidence::detail
