#include "mansard/segment/options.hpp"

namespace mansard::segment {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("segment");
  list.number("alpha", o.alpha, "", {0, 1e6}, "Cost of leaving a metre of sweep-edge unused.")
      .alias("alpha")
      .source("paper: 40");
  list.number("beta", o.beta, "", {0, 1e6}, "Cost of a metre of footprint edge that is not on a sweep-edge.")
      .alias("beta")
      .source("paper: 60");
  list.number("height_weight", o.height_weight, "", {0, 1e6},
              "Cost of joining faces across a metre of edge, per metre of height difference.")
      .source("docs/decisions/0012");
  list.number("phi", o.phi, "", {0, 1e6},
              "Cost of a pair of edges that make a sliver or a needle, as a share of the total edge length.")
      .source("paper: 0.5");
  list.number("thin_distance", o.thin_distance, "m", {0, 100},
              "Opposite edges nearer to each other than this make a sliver.")
      .source("paper: 2 m");
  list.number("thin_angle", o.thin_angle, "rad", {0, 1.5}, "Adjacent edges under this angle make a needle.")
      .source("paper: 30°");
  list.choice("continuations", o.continuations, {{"sweep", Continuations::sweep}, {"plain", Continuations::plain}},
              "Whether the continuations of sweep-edges count as sweep-edges.")
      .source("docs/decisions/0012");
  list.choice(
          "thin_rule", o.thin_rule,
          {{"any", ThinRule::any}, {"all", ThinRule::all}, {"unsupported", ThinRule::unsupported}},
          "Which near edges make a sliver: any two that do not meet; all that face each other; of these, those that "
          "were not seen from both sides.")
      .source("docs/decisions/0012");
  list.choice("thin_reach", o.thin_reach, {{"face", ThinReach::face}, {"block", ThinReach::block}},
              "Whether slivers and needles are looked for within single faces, or across several too.")
      .source("docs/decisions/0012");
  list.choice("height_measure", o.height_measure, {{"along", HeightMeasure::along}, {"median", HeightMeasure::median}},
              "Whether height differences are measured along the edge, or between the faces' medians.")
      .source("docs/decisions/0012");
  list.number("height_offset", o.height_offset, "m", {0.01, 10},
              "Distance from an edge, to both sides, at which heights are sampled along it.")
      .source("twice the melted half width of a wall in the scans of tools/datasets.toml; not measured");
  list.choice("gis_edges", o.gis_edges,
              {{"ignore", GisEdges::ignore}, {"candidate", GisEdges::candidate}, {"hard", GisEdges::hard}},
              "Whether edges between two features cut the ground: not, where that pays, or always.")
      .source("docs/decisions/0004 and 0006");
  list.number("gis_alpha", o.gis_alpha, "", {0, 1e6},
              "Cost of leaving a metre of GIS edge unused, with gis_edges = candidate.")
      .source("chosen by hand; not measured");
  list.number("gis_ratio", o.gis_ratio, "", {0, 1},
              "A face is inside when at least this share of it is inside the footprints.")
      .source("reference implementation chordatlas: 4 of 9 samples");
  list.number("min_height", o.min_height, "m", {0, 1000},
              "A face is inside when its median height above ground is at least this.")
      .source("half of the reference implementation's 4 m, so that sheds and garages are kept; not measured");
  list.number("exposed", o.exposed, "", {0, 1e6},
              "Faces with more wall-less boundary than this share of the rest are peeled off.")
      .source("reference implementation chordatlas: 0.4");
  list.number("narrow", o.narrow, "m", {0, 100},
              "Parts of less mean width go to their neighbour, or are left out as strips outside a wall; 0 keeps them.")
      .source("docs/decisions/0009");
  list.integer("samples", o.samples, "", {9, 100000}, "Maximum number of height samples per face.")
      .source("chosen by hand; not measured");
  list.number("seconds", o.seconds, "s", {0, 1e6},
              "Time limit per block; without one, blocks are solved until proven optimal.")
      .source("no limit, since a limit in time makes the result depend on the machine");
  list.integer("nodes", o.nodes, "", {0, 1e9}, "Maximum number of branch-and-bound nodes per solve.")
      .source("chosen by hand; the segmentations measured in docs/segment.md need far fewer");
  list.flag("cliques", o.cliques, "Give the solver a row for every clique of conflicts as well.")
      .source("docs/segment.md");
  list.number("thin_shortest", o.thin_shortest, "m", {0, 50},
              "Minimum length of an edge that can make a sliver or a needle.")
      .advanced("chosen by hand; not measured");
  list.number("thin_parallel", o.thin_parallel, "rad", {0, 1.5}, "Maximum angle between two edges that make a sliver.")
      .advanced("reference implementation chordatlas: 0.3 rad");
  list.number("samples_per_area", o.samples_per_area, "1/m²", {0.01, 1000},
              "Height samples per area of a face, up to segment.samples.")
      .advanced("as dense as the reference implementation's 2 m grid is sparse: eight times as many; not measured");
  list.number("gis_near", o.gis_near, "m", {0.001, 10},
              "Maximum distance between an edge of a footprint and a neighbour's edge or a wall that runs along it.")
      .advanced("docs/decisions/0015; not measured");
  list.number("gis_shortest", o.gis_shortest, "m", {0.001, 50},
              "Minimum length of a piece of a footprint's edge that is inserted, and of a gap between two pieces.")
      .advanced("docs/decisions/0015");
  list.number("smallest_part", o.smallest_part, "m²", {0, 1000},
              "Parts with less area than this are joined to a neighbour or left out.")
      .advanced("chosen by hand; not measured");
  list.number("collinear", o.collinear, "m", {0, 1},
              "Corners of a part nearer than this to the edge without them are removed.")
      .advanced("a tenth of what surveys resolve; not measured");
  return list;
}

}  // namespace mansard::segment
