#include "mansard/fracture/fracture.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "mansard/base/text.hpp"
#include "mansard/fracture/detail/faces.hpp"
#include "mansard/fracture/detail/insertion.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture {
namespace {

using detail::Point2, detail::Segment2, detail::Box2;
using detail::square, detail::to_grid;

auto name_of(const Cut& cut) -> std::string { return "cut " + std::to_string(cut.source); }

auto usable(Point2 p) -> bool { return std::abs(p.x) <= detail::farthest && std::abs(p.y) <= detail::farthest; }

auto first_unusable(const std::vector<Cut>& cuts, const Box2& region) -> std::optional<base::Diagnostic> {
  const std::string words = "is not a finite number, or lies farther than 10,000 km from the origin";
  for (const Cut& cut : cuts)
    if (!usable(cut.segment.start) || !usable(cut.segment.end))
      return base::error("fracture-not-finite", "an end of the line " + words, name_of(cut));
  if (!region.empty() && (!usable(region.least) || !usable(region.most)))
    return base::error("fracture-not-finite", "a corner of the region " + words, "region");
  return std::nullopt;
}

/// Around everything, with room for at least two merged vertices a side.
auto rectangle_of(const std::vector<Cut>& cuts, const Box2& region, const Options& options) -> Box2 {
  Box2 box = region.empty() ? Box2{} : region;
  for (const Cut& cut : cuts) box.include(Box2::of(cut.segment));
  const double margin = to_grid(options.margin);
  box = Box2{to_grid(box.least), to_grid(box.most)}.grown(margin);
  const double least = to_grid(2 * options.snap), room = 2 * least;
  if (box.most.x - box.least.x < room) box.least.x -= least, box.most.x += least;
  if (box.most.y - box.least.y < room) box.least.y -= least, box.most.y += least;
  return box;
}

// A cut laid down beside its place must stay within Tolerances::drift of it, which is two merging distances less the
// slack: the farthest try leaves 0.8 of one for the vertices that draw it in. Its thirds are tried before it.
constexpr std::array<double, 3> shifts{0.4, 0.8, 1.2};  // merging distances
// Half a merging distance more attraction: still 0.5 of one within the drift.
constexpr double wider_attraction = 1.5;

/// What is tried for one cut, best first: as asked; drawn to vertices from farther away; laid down a little beside its
/// place, first on the side of the rectangle's middle (so that a mirrored plane takes the mirrored choice); the same
/// with no continuation but to the next edge.
auto attempts_for(const detail::Line& line, Point2 middle, double asked, double merge) -> std::vector<detail::Attempt> {
  const double inwards = geometry::orientation(line.hard.start, line.hard.end, middle) < 0 ? -merge : merge;
  std::vector<detail::Attempt> attempts;
  for (const double continuation : {asked, 0.0}) {
    attempts.push_back({continuation, 1, 0, 0});
    attempts.push_back({continuation, wider_attraction, 0, 0});
    for (const double shift : shifts) {
      const double by = shift * inwards;
      for (const auto& [start, end] :
           {std::pair(by, by), {-by, -by}, {by, -by}, {-by, by}, {by, 0.0}, {0.0, by}, {-by, 0.0}, {0.0, -by}})
        attempts.push_back({continuation, 1, start, end});
    }
  }
  return attempts;
}

struct Outcome {
  Arrangement arrangement;
  std::optional<std::string> fault;
};

/// Inserts all cuts in order. A cut that cannot settle is taken out and tried otherwise; `wary` looks at the whole
/// after every cut rather than once at the end.
auto insert_all(const std::vector<Cut>& cuts, const Box2& rectangle, const Options& options, bool wary,
                const base::Run& run) -> Outcome {
  const detail::Tolerances tolerances(options);
  detail::Graph graph(rectangle, tolerances.merge);
  std::vector<detail::Line> lines;
  for (const Cut& cut : cuts) {
    const Segment2 line{to_grid(cut.segment.start), to_grid(cut.segment.end)};
    lines.push_back({line, line});
  }
  detail::Insertion insertion(graph, lines, tolerances);
  const Point2 middle = rectangle.least + 0.5 * (rectangle.most - rectangle.least);
  std::vector<base::Diagnostic> warnings;
  for (std::uint32_t i = 0; i < cuts.size() && !run.cancelled(); ++i) {
    if (detail::squared_distance(lines[i].hard.start, lines[i].hard.end) < square(options.snap)) {
      warnings.push_back(
          base::warning("fracture-cut-short", "shorter than the snapping distance; ignored", name_of(cuts[i])));
      continue;
    }
    const auto mark = graph.mark();
    const auto attempts = attempts_for(lines[i], middle, options.continuation, tolerances.merge);
    const bool inserted = std::ranges::any_of(attempts, [&](const detail::Attempt& attempt) {
      if (insertion.lay(i, attempt) && (!wary || !detail::fault_of(detail::faces_of(graph, cuts), options.snap)))
        return true;
      graph.back_to(mark);
      return false;
    });
    if (!inserted)
      warnings.push_back(base::warning("fracture-cut-left-out",
                                       "too entangled with others within the snapping distance", name_of(cuts[i])));
  }
  Outcome outcome{detail::faces_of(graph, cuts), std::nullopt};
  outcome.fault = detail::fault_of(outcome.arrangement, options.snap);
  outcome.arrangement.warnings = std::move(warnings);
  return outcome;
}

}  // namespace

auto Arrangement::ring(std::uint32_t face) const -> geometry::Ring {
  geometry::Ring ring;
  std::uint32_t h = faces[face].edge;
  do {
    ring.push_back(vertices[half_edges[h].from]);
    h = half_edges[h].next;
  } while (h != faces[face].edge);
  return ring;
}

auto arrange(const std::vector<Cut>& cuts, const geometry::Box2& region, const Options& options, const base::Run& run)
    -> base::Result<Arrangement> {
  assert(options.snap > 0 && options.continuation >= 0 && options.margin >= 0);
  if (auto unusable = first_unusable(cuts, region)) return *std::move(unusable);
  if (cuts.empty() && region.empty()) return Arrangement{};  // nothing to fracture

  const Box2 rectangle = rectangle_of(cuts, region, options);
  Outcome outcome = insert_all(cuts, rectangle, options, false, run);
  if (outcome.fault) outcome = insert_all(cuts, rectangle, options, true, run);
  assert(!outcome.fault);
  return std::move(outcome.arrangement);
}

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("fracture");
  list.number("continuation", o.continuation, "m", {0, 1000},
              "A line continues for this length beyond both ends, then to the next edge.")
      .source("paper: 2 m");
  list.number("snap", o.snap, "m", {0.001, 1}, "Vertices and lines nearer to each other than this become one.")
      .source("chosen by hand; not measured");
  list.number("margin", o.margin, "m", {0, 1000},
              "Distance from the lines to the rectangle that bounds the fractured ground.")
      .source("reference implementation chordatlas: 10 m");
  return list;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"fracture-not-finite",
       "A line to fracture the ground by is not a finite number, or lies farther than 10,000 km from the origin.",
       "Check the mesh and the footprints for broken coordinates and for different coordinate systems.", 1},
      {"fracture-cut-short", "A line shorter than fracture.snap was ignored.",
       "Nothing to do; lower fracture.snap if such short walls matter.", 0},
      {"fracture-cut-left-out",
       "A line could not be inserted without bringing vertices nearer than fracture.snap to each other.",
       "Nothing to do if it is one of many along the same wall; else change fracture.snap a little.", 0},
  };
}

}  // namespace mansard::fracture
