#include "mansard/segment/terms.hpp"

#include "mansard/base/metres.hpp"
#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment {
namespace {

using HalfEdge = fracture::HalfEdge;

constexpr std::array<TermInfo, term_count> all{{
    {Term::sweep_unused, Paid::uncut, "sweep_unused", "O1 α", "unused sweep-edges", "unused", "cost_sweep_unused",
     "sweep_length", &Options::alpha,
     [](const HalfEdge& h, const Options& o) { return detail::is_sweep(h, o) ? 1.0 : 0.0; },
     [](double amount) { return "leaving " + base::metres(amount) + " of sweep-edge unused"; }},
    {Term::unsupported, Paid::cut, "unsupported", "O1 β", "walls without a sweep-edge", "unsupported",
     "cost_unsupported", "unsupported_length", &Options::beta,
     [](const HalfEdge& h, const Options& o) { return detail::is_supported(h, o) ? 0.0 : 1.0; },
     [](double amount) { return base::metres(amount) + " without a sweep-edge"; }},
    {Term::height, Paid::uncut, "height", "O2", "height steps", "steps", "cost_height", "height_difference",
     &Options::height_weight, nullptr, [](double amount) { return "the height step of " + base::metres(amount); }},
    {Term::thin, Paid::cut, "thin", "O7", "conflicts", "thin", "cost_outline_conflict", "", nullptr, nullptr,
     [](double) { return std::string("its conflict with the outline"); }},
    {Term::gis_unused, Paid::uncut, "gis_unused", "GIS", "unused GIS edges", "GIS", "cost_gis_unused", "gis_length",
     &Options::gis_alpha, [](const HalfEdge& h, const Options& o) { return detail::pays_as_gis(h, o) ? 1.0 : 0.0; },
     [](double amount) { return "leaving " + base::metres(amount) + " of GIS edge unused"; }},
}};

constexpr auto in_order() -> bool {
  for (std::size_t i = 0; i < term_count; ++i)
    if (all[i].term != static_cast<Term>(i)) return false;
  return true;
}
static_assert(in_order(), "every term has a row, in the order of Term");

}  // namespace

auto terms() -> std::span<const TermInfo, term_count> { return all; }

auto Terms::sum(Paid paid) const -> double {
  double some = 0;
  for (const TermInfo& info : all)
    if (info.paid == paid) some += (*this)[info.term];
  return some;
}

}  // namespace mansard::segment
