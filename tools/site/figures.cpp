// The pictures of the modules' pages, each made by the module itself of a sample: site_figures DATA OUTDIR
// Not installed and not part of the test run: docs/pictures/modules is what it wrote last.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>

#include "lab/explore/explore.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/planes/planes.hpp"
#include "mansard/report/pictures.hpp"

namespace {

using namespace mansard;
namespace fs = std::filesystem;
using geometry::Box2, geometry::Point2, geometry::Polygon, geometry::Ring, geometry::Segment2;

/// Lines and areas in metres, as an SVG of so many pixels; north is up.
class Drawing {
 public:
  Drawing(const Box2& box, double width)
      : box_(box),
        scale_(width / (box.most.x - box.least.x)),
        width_(width),
        height_(scale_ * (box.most.y - box.least.y)) {}

  void area(const Polygon& polygon, const std::string& style) {
    std::string path = ring(polygon.outer);
    for (const auto& hole : polygon.holes) path += ring(hole);
    body_ += "<path d=\"" + path + "\" fill-rule=\"evenodd\" style=\"" + style + "\"/>\n";
  }
  void line(const std::vector<Point2>& points, const std::string& style) {
    body_ += "<path d=\"" + open(points) + "\" style=\"fill:none;" + style + "\"/>\n";
  }
  /// All in one element: thousands of pieces of one kind stay small.
  void lines(const std::vector<Segment2>& segments, const std::string& style) {
    std::string path;
    for (const auto& s : segments) path += open({s.start, s.end});
    body_ += "<path d=\"" + path + "\" style=\"fill:none;" + style + "\"/>\n";
  }
  void dot(Point2 at, double radius, const std::string& style) {
    body_ += "<circle cx=\"" + x(at.x) + "\" cy=\"" + y(at.y) + "\" r=\"" + base::to_text(radius, 1) + "\" style=\"" +
             style + "\"/>\n";
  }
  void text(Point2 at, const std::string& words, const std::string& style = "") {
    body_ += "<text x=\"" + x(at.x) + "\" y=\"" + y(at.y) + "\" style=\"font:13px sans-serif;" + style + "\">" + words +
             "</text>\n";
  }
  [[nodiscard]] auto svg() const -> std::string {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + base::to_text(width_, 0) + "\" height=\"" +
           base::to_text(height_, 0) + "\" viewBox=\"0 0 " + base::to_text(width_, 0) + " " +
           base::to_text(height_, 0) + "\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" + body_ +
           "</svg>\n";
  }

 private:
  [[nodiscard]] auto x(double at) const -> std::string { return base::to_text(scale_ * (at - box_.least.x), 1); }
  [[nodiscard]] auto y(double at) const -> std::string {
    return base::to_text(height_ - scale_ * (at - box_.least.y), 1);
  }
  [[nodiscard]] auto open(const std::vector<Point2>& points) const -> std::string {
    std::string path;
    for (const auto& p : points) path += (path.empty() ? "M" : "L") + x(p.x) + " " + y(p.y);
    return path;
  }
  [[nodiscard]] auto ring(const Ring& points) const -> std::string { return open(points) + "Z"; }

  Box2 box_;
  double scale_, width_, height_;
  std::string body_;
};

/// A colour that goes with a number: neighbours in number differ.
auto hue(std::size_t i, int light = 70) -> std::string {
  return "hsl(" + std::to_string((i * 137 + 20) % 360) + " 45% " + std::to_string(light) + "%)";
}

auto box_of(const std::vector<Polygon>& polygons) -> Box2 {
  Box2 box;
  for (const auto& polygon : polygons)
    for (const auto& p : polygon.outer) box.add(p);
  return box;
}

[[noreturn]] void fail(const base::Diagnostic& why) {
  std::fprintf(stderr, "site_figures: %s\n", base::to_string(why).c_str());
  std::exit(1);
}
template <class T>
auto need(base::Result<T> result) -> T {
  if (!result) fail(result.error());
  return std::move(*result);
}

struct Figures {
  fs::path data, out;

  void put(const std::string& name, const std::string& bytes) const {
    if (auto done = base::write_file(out / name, bytes); !done) fail(done.error());
    std::printf("%s\n", (out / name).c_str());
  }
  void put(const std::string& name, const picture::Image& image) const { put(name, need(picture::png(image))); }
};

void rooms_in_plan(const Figures& to, const model::Scene& scene, const pipeline::Options& options) {
  const auto blocks = block::partition(scene, options.block);
  std::vector<Polygon> all;
  for (const auto& footprint : scene.footprints)
    all.insert(all.end(), footprint.polygons.begin(), footprint.polygons.end());
  Drawing plan(box_of(all).grown(5), 760);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (const auto& member : blocks[b].members)
      for (const auto& polygon : member.polygons) plan.area(polygon, "fill:" + hue(b) + ";stroke:#fff;stroke-width:.8");
    for (const auto& polygon : blocks[b].outline)
      plan.area(polygon, "fill:none;stroke:" + hue(b, 30) + ";stroke-width:1.6");
  }
  to.put("block.svg", plan.svg());

  const auto& block = *std::ranges::max_element(
      blocks, {}, [](const auto& b) { return b.members.size() <= 16 ? b.members.size() : 0; });
  const rays::Scene mesh(block.mesh);
  const auto frame = box_of(block.outline).grown(4);
  const auto footprints = [&](Drawing& drawing) {
    for (const auto& member : block.members)
      for (const auto& polygon : member.polygons) drawing.area(polygon, "fill:#fdf0dd;stroke:#f08c1e;stroke-width:1");
  };
  const auto stack = slice::cut(block, options.slice);
  Drawing slices(frame, 760);
  footprints(slices);
  const std::size_t every = 7;
  for (std::size_t i = every; i < stack.slices.size(); i += every) {
    const auto shade = std::to_string(240 - 240 * i / stack.slices.size());
    slices.lines(stack.slices[i].segments, "stroke:hsl(" + shade + " 70% 45%);stroke-width:.9");
  }
  to.put("slice.svg", slices.svg());

  const auto edges = sweep::find_edges(stack, block, options.sweep);
  Drawing sweeps(frame, 760);
  footprints(sweeps);
  for (const auto& edge : edges.edges)
    sweeps.line({edge.segment.start, edge.segment.end},
                "stroke:#23589c;stroke-width:" + base::to_text(1.2 + std::min(4.0, edge.area / 30), 1));
  to.put("sweep.svg", sweeps.svg());

  const auto cuts = segment::cuts_of(edges, block, options.segment);
  const auto ground = need(fracture::arrange(cuts, box_of(block.outline), options.fracture));
  Drawing fractured(frame, 760);
  for (std::uint32_t f = 0; f < ground.faces.size(); ++f)
    fractured.area({ground.ring(f), {}}, "fill:" + hue(f, 88) + ";stroke:#8a8a94;stroke-width:.6");
  std::vector<Segment2> hard;
  for (std::uint32_t h = 0; h < ground.half_edges.size(); h += 2)
    if (std::ranges::any_of(ground.half_edges[h].origins, [](const auto& o) { return o.kind == fracture::Kind::hard; }))
      hard.push_back(ground.segment(h));
  fractured.lines(hard, "stroke:#23589c;stroke-width:2");
  to.put("fracture.svg", fractured.svg());

  const auto chosen = need(segment::choose(ground, edges, block, mesh, options.segment));
  Drawing segmented(frame, 760);
  for (std::size_t p = 0; p < chosen.parts.size(); ++p)
    segmented.area(chosen.parts[p].polygon, "fill:" + hue(p, 78) + ";stroke:none");
  std::vector<Segment2> cut, uncut;
  for (const auto& candidate : chosen.candidates)
    for (const auto h : candidate.half_edges) (candidate.chosen ? cut : uncut).push_back(ground.segment(h));
  segmented.lines(uncut, "stroke:#9a9aa4;stroke-width:.6;stroke-dasharray:3 3");
  segmented.lines(cut, "stroke:#b03030;stroke-width:2.2");
  for (const auto& part : chosen.parts) segmented.area(part.polygon, "fill:none;stroke:#333;stroke-width:1");
  to.put("segment.svg", segmented.svg());

  // The mesh behind the edge of most slices that carries a pitch, and the profile that was fitted to it.
  const auto fitted = profile::fit(chosen, block, mesh, options.profile);
  const auto edge_in = [](const profile::ProfiledFootprint& part, std::size_t i) {
    const auto& points = part.plan.outer.points;
    return Segment2{points[i], points[(i + 1) % points.size()]};
  };
  const profile::ProfiledFootprint* pitched = nullptr;
  std::size_t edge = 0, most = 0;
  for (const auto& part : fitted)
    for (std::size_t i = 0; i < part.plan.outer.points.size(); ++i) {
      const auto number = part.plan.outer.profile_of_edge[i];
      const auto& points = part.plan.profiles[number];
      if (points.size() < 3 || part.evidence[number].slices <= most) continue;
      const auto &last = points.back(), &before = points[points.size() - 2];
      const double run = last.inward - before.inward, rise = last.height - before.height;
      if (run < .5 || rise < .4 * run || rise > 1.5 * run) continue;
      pitched = &part, edge = i, most = part.evidence[number].slices;
    }
  if (pitched == nullptr) fail(base::error("bug", "no edge of the block carries a pitch"));
  const auto& plan_of_edge = pitched->plan;
  const auto foot = edge_in(*pitched, edge);
  const double cap = plan_of_edge.cap;
  Drawing profile({{-2, -1}, {10, cap + 1.5}}, 640);
  for (int i = 1; i < 20; ++i) {
    const auto section = edit::section(block.mesh, foot.start, foot.end, i / 20.0, plan_of_edge.base, 10);
    std::vector<Segment2> pieces;
    for (const auto& [a, b] : section.pieces) pieces.push_back({{a.inward, a.height}, {b.inward, b.height}});
    profile.lines(pieces, "stroke:#7a9acc;stroke-width:.7;opacity:.6");
  }
  std::vector<Point2> clean;
  for (const auto& p : plan_of_edge.profiles[plan_of_edge.outer.profile_of_edge[edge]])
    clean.push_back({p.inward, p.height});
  const auto last = clean.back(), before = clean[clean.size() - 2];
  if (cap > last.y)
    clean.push_back(last + ((cap - last.y) / (last.y - before.y)) * (last - before));  // it goes on to the cap
  profile.line({{-2, cap}, {10, cap}}, "stroke:#777;stroke-width:1;stroke-dasharray:6 4");
  profile.text({7.5, cap + .2}, "cap");
  profile.line(clean, "stroke:#b03030;stroke-width:2.5");
  profile.line({{-2, 0}, {10, 0}}, "stroke:#333;stroke-width:1");
  profile.text({6.8, -.6}, "inward from the edge, m");
  for (int at = 0; at <= 10; at += 2) profile.text({double(at), -.6}, at == 8 ? "" : std::to_string(at));
  for (int h = 2; h < cap; h += 2) profile.text({-1.9, h + .1}, std::to_string(h) + " m");
  to.put("profile.svg", profile.svg());

  const auto& part =
      *std::ranges::max_element(fitted, {}, [](const auto& p) { return geometry::area(model::polygon_of(p.plan)); });
  const auto& ring = part.plan.outer;
  const auto edge_of = [&](std::size_t i) { return edge_in(part, i); };
  std::size_t longest = 0;
  for (std::size_t i = 1; i < ring.points.size(); ++i)
    if (geometry::length(edge_of(i).end - edge_of(i).start) >
        geometry::length(edge_of(longest).end - edge_of(longest).start))
      longest = i;

  // The plan of a part with its profiles, as plans.json has it.
  Box2 around;
  for (const auto& p : ring.points) around.add(p);
  Drawing plans(around.grown(2.5), 640);
  plans.area(model::polygon_of(part.plan), "fill:#eee;stroke:none");
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const auto s = edge_of(i);
    plans.line({s.start, s.end}, "stroke:" + hue(ring.profile_of_edge[i], 45) + ";stroke-width:4");
    const auto out = normalised(-1 * geometry::left_of(s.end - s.start));
    if (geometry::length(s.end - s.start) > 1.5)
      plans.text(.5 * (s.start + s.end) + 1.1 * out, "p" + std::to_string(ring.profile_of_edge[i]));
  }
  for (const auto& p : ring.points) plans.dot(p, 3, "fill:#333");
  to.put("write.svg", plans.svg());

  // The block's vertical error with the caps alone refined, and with all of it.
  std::vector<picture::Image> before_after;
  for (const auto effort : {refine::Effort::caps, refine::Effort::parts}) {
    auto with = options;
    with.refine.effort = effort;
    const auto made = need(pipeline::reconstruct(scene, with, {}, pipeline::Keep::models, std::vector{block.name}));
    before_after.push_back(need(report::pictures(made, scene, 2)).error);
  }
  to.put("refine.png", picture::beside(before_after));

  // Its halves after a split across.
  const Point2 middle = .5 * (edge_of(longest).start + edge_of(longest).end);
  const auto inward = normalised(geometry::left_of(edge_of(longest).end - edge_of(longest).start));
  const auto halves = need(edit::split(part.plan, std::vector{middle - 30 * inward, middle + 30 * inward}));
  Drawing split(around.grown(2.5), 640);
  std::size_t number = 0;
  for (const auto& half : halves)
    split.area(model::polygon_of(half), "fill:" + hue(number++, 82) + ";stroke:#333;stroke-width:1.5");
  split.line({middle - 2 * inward, middle + 14 * inward}, "stroke:#b03030;stroke-width:2;stroke-dasharray:7 5");
  to.put("edit.svg", split.svg());
}

void surfaces(const Figures& to, const model::Scene& scene, const pipeline::Options& options) {
  const picture::View view{.kind = picture::View::Kind::angle, .width = 900, .height = 600};
  std::vector<picture::Layer> scan{{scene.mesh, {picture::mesh_blue}}};
  picture::Lines outlines;
  const rays::Scene mesh(scene.mesh);
  for (const auto& footprint : scene.footprints)
    for (const auto& polygon : footprint.polygons)
      for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
        const auto a = polygon.outer[i], b = polygon.outer[(i + 1) % polygon.outer.size()];
        for (int k = 0; k < 60; ++k) {
          const auto p = a + (k / 60.0) * (b - a), q = a + ((k + 1) / 60.0) * (b - a);
          outlines.segments.push_back({{{p.x, p.y, mesh.top(p).value_or(0)}, {q.x, q.y, mesh.top(q).value_or(0)}}});
        }
      }
  to.put("ingest.png", picture::draw(scan, std::vector{outlines}, view));

  Box2 box;
  for (const auto& v : scene.mesh.vertices) box.add(geometry::xy(v));
  const double step = (box.most.x - box.least.x) / 220;
  std::vector<float> heights;
  std::vector<double> sorted;
  const auto columns = static_cast<std::size_t>((box.most.x - box.least.x) / step);
  const auto rows = static_cast<std::size_t>((box.most.y - box.least.y) / step);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const auto z = mesh.top(box.least + step * Point2{static_cast<double>(c) + .5, static_cast<double>(r) + .5});
      heights.push_back(z ? static_cast<float>(*z) : std::numeric_limits<float>::quiet_NaN());
      if (z) sorted.push_back(*z);
    }
  std::ranges::sort(sorted);
  const auto zero = static_cast<float>(.5 * (sorted[sorted.size() / 50] + sorted[sorted.size() * 49 / 50]));
  for (auto& h : heights) h -= zero;
  to.put("rays.png",
         picture::error_map(heights, columns, rows, (sorted[sorted.size() * 49 / 50] - sorted[sorted.size() / 50]) / 2,
                            "TOP HEIGHT"));

  to.put("label.png", report::picture_of(need(pipeline::reconstruct(scene, options)).city, view));
}

/// The scan from above with the footprints that are drawn of it.
void derived(const Figures& to, const model::Scene& scene) {
  double highest = -1e30;
  for (const auto& v : scene.mesh.vertices) highest = std::max(highest, v.z);
  picture::Lines outlines;
  outlines.colour = {214, 40, 40};
  outlines.width = 3;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto a = ring[i], b = ring[(i + 1) % ring.size()];
      outlines.segments.push_back({{{a.x, a.y, highest + 1}, {b.x, b.y, highest + 1}}});
    }
  };
  const auto derived = need(derive::footprints(scene, {}));
  for (const auto& footprint : derived.footprints)
    for (const auto& polygon : footprint.polygons) {
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
  const picture::View view{.kind = picture::View::Kind::above, .width = 560, .height = 560};
  to.put("derive.png",
         picture::draw(std::vector<picture::Layer>{{scene.mesh, {picture::mesh_blue}}}, std::vector{outlines}, view));
}

void polygons(const Figures& to) {
  const Polygon a{{{0, 0}, {8, 0}, {8, 5}, {0, 5}}, {}}, b{{{5, 2}, {11, 2}, {11, 8}, {5, 8}}, {}};
  Drawing drawing({{-1, -2}, {47, 9}}, 860);
  const auto row = [&](double at, const char* name, const std::vector<Polygon>& result) {
    for (const auto& polygon : {a, b}) {
      Polygon moved = polygon;
      for (auto& p : moved.outer) p = p + Point2{at, 0};
      drawing.area(moved, "fill:none;stroke:#aaa;stroke-width:1;stroke-dasharray:4 3");
    }
    for (Polygon polygon : result) {
      for (auto& p : polygon.outer) p = p + Point2{at, 0};
      drawing.area(polygon, "fill:#c9d8ee;stroke:#23589c;stroke-width:2");
      for (const auto& p : polygon.outer) drawing.dot(p, 3, "fill:#23589c");
    }
    drawing.text({at, -1.5}, name);
  };
  row(0, "unite", need(geometry::unite(std::vector{a, b})));
  row(12, "intersect", need(geometry::intersect(a, b)));
  row(24, "subtract", need(geometry::subtract(a, b)));
  row(36, "buffer", need(geometry::buffer(a, -1)));
  to.put("geometry.svg", drawing.svg());
}

void program(const Figures& to) {
  // Maximise x + 1.4 y over the whole points under two lines: what the relaxation would choose, and what is chosen.
  solver::Program program;
  program.variables = {{.cost = -1, .least = 0, .most = 8}, {.cost = -1.4, .least = 0, .most = 8}};
  program.rows = {{{{0, 3}, {1, 5}}, -1e30, 26}, {{{0, 4}, {1, 1}}, -1e30, 23}};
  const auto whole = need(solver::minimise(program, {}));
  for (auto& variable : program.variables) variable.whole = false;
  const auto relaxed = need(solver::minimise(program, {}));
  Drawing drawing({{-1, -1}, {9, 7}}, 560);
  const Point2 corner{relaxed.values[0], relaxed.values[1]};
  drawing.area({{{0, 0}, {23.0 / 4, 0}, corner, {0, 26.0 / 5}}, {}}, "fill:#e4ecf7;stroke:#23589c;stroke-width:1.5");
  for (int x = 0; x <= 8; ++x)
    for (int y = 0; y <= 6; ++y)
      drawing.dot({double(x), double(y)}, 3, 3 * x + 5 * y <= 26 && 4 * x + y <= 23 ? "fill:#23589c" : "fill:#ccc");
  drawing.dot(corner, 6, "fill:none;stroke:#b03030;stroke-width:2");
  drawing.dot({whole.values[0], whole.values[1]}, 7, "fill:#b03030");
  drawing.text(corner + Point2{.25, .25}, "bound " + base::to_text(relaxed.objective, 2));
  drawing.text(Point2{whole.values[0], whole.values[1]} + Point2{-1.1, .35},
               "optimum " + base::to_text(whole.objective, 2));
  to.put("solver.svg", drawing.svg());
}

/// The points of a laser scan over some houses, by the planes that they lie on.
void measured_planes(const Figures& to, const pipeline::Options& options) {
  const auto scene =
      need(ingest::read_scene({to.data / "delft/points.laz"}, to.data / "delft/footprints.geojson", options.ingest));
  const auto block = block::partition(scene, options.block).front();
  const auto& points = block.mesh.points;
  const auto found = planes::find(points, {0.02, 0.14, 1});
  const Point2 middle = 0.5 * (box_of(block.outline).least + box_of(block.outline).most);
  const Box2 shown{middle - Point2{18.5, 11.5}, middle + Point2{18.5, 11.5}};
  Drawing drawing(shown, 860);
  std::vector<std::vector<Segment2>> by_plane(found.planes.size());
  std::vector<Segment2> others;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2 at = xy(points[i]);
    if (!shown.contains(at)) continue;
    const Segment2 dot{at, at + Point2{0.01, 0}};
    if (found.plane_of[i] < by_plane.size()) by_plane[found.plane_of[i]].push_back(dot);
    else others.push_back(dot);
  }
  for (std::size_t p = 0; p < by_plane.size(); ++p)
    if (!by_plane[p].empty())
      drawing.lines(by_plane[p], "stroke:" + hue(p, 45) + ";stroke-width:4;stroke-linecap:round");
  drawing.lines(others, "stroke:#222;stroke-width:2;stroke-linecap:round");
  for (const auto& member : block.members)
    for (const auto& polygon : member.polygons) drawing.area(polygon, "fill:none;stroke:#d62828;stroke-width:1.5");
  to.put("planes.svg", drawing.svg());
}

using Kept = std::function<bool(const formats::CloudPoint&)>;

/// The points of a cloud that are kept, beside the models that the program makes of these: within `street` of the
/// footprints, as squares of twice `half`.
void points_and_models(const Figures& to, const std::string& name, const std::vector<formats::CloudPoint>& cloud,
                       const fs::path& footprints, pipeline::Options options, const Kept& kept, double half,
                       double street, const picture::View& view) {
  std::vector<formats::CloudPoint> points;
  std::ranges::copy_if(cloud, std::back_inserter(points), kept);
  std::string text = "x,y,z,class\n";
  for (const auto& p : points)
    text += base::to_text(p.position.x, 3) + "," + base::to_text(p.position.y, 3) + "," +
            base::to_text(p.position.z, 3) + "," + std::to_string(p.classification) + "\n";
  const auto file = fs::temp_directory_path() / "site_figures.csv";
  if (auto done = base::write_file(file, text); !done) fail(done.error());
  const auto scene = need(ingest::read_scene({file}, footprints, options.ingest));
  fs::remove(file);
  const auto city = need(pipeline::reconstruct(scene, options)).city;
  const auto models = report::textured_models(city, formats::Solids::building);

  geometry::Box3 box;
  for (const auto& v : models.mesh.vertices) box.add(v);
  std::vector<Polygon> near;
  for (const auto& footprint : scene.footprints)
    for (const auto& polygon : footprint.polygons)
      std::ranges::copy(need(geometry::buffer(polygon, street)), std::back_inserter(near));
  const auto& origin = scene.frame.origin;
  picture::Layer dots, pale;
  for (const auto& point : points) {
    const geometry::Point3 p =
        point.position - geometry::Point3{double(origin[0]), double(origin[1]), double(origin[2])};
    if (!geometry::contains(near, geometry::xy(p))) continue;
    const bool classified = point.classification != 0;
    const bool roof = classified ? point.classification == 6 : p.z > box.least.z + 1.5;
    for (auto* layer : {&dots, &pale}) {
      if (layer == &pale && (roof || point.classification == 1)) continue;  // no trees before the models
      const auto first = static_cast<std::uint32_t>(layer->mesh.vertices.size());
      for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
        layer->mesh.vertices.push_back({p.x + x, p.y + y, p.z});
      layer->mesh.triangles.push_back({first, first + 1, first + 2});
      layer->mesh.triangles.push_back({first, first + 2, first + 3});
      const picture::Colour colour = layer == &pale              ? picture::Colour{206, 216, 232}
                                     : !classified               ? picture::mesh_blue
                                     : roof                      ? picture::Colour{196, 84, 66}
                                     : point.classification == 2 ? picture::Colour{150, 140, 120}
                                                                 : picture::Colour{120, 160, 110};
      layer->colours.insert(layer->colours.end(), 2, colour);
    }
  }
  // Both pictures have the frame of points and models together.
  for (const auto& v : dots.mesh.vertices) box.add(v);
  picture::Layer corners;
  corners.colours = {{250, 250, 250}};
  for (const auto& p : {box.least, box.most}) {
    const auto first = static_cast<std::uint32_t>(corners.mesh.vertices.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.001, 0.0}, {0.0, 0.001}})
      corners.mesh.vertices.push_back({p.x + x, p.y + y, p.z});
    corners.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const std::vector<picture::Image> both{picture::draw(std::vector{dots, corners}, {}, view),
                                         picture::draw(std::vector{models, pale, corners}, {}, view)};
  to.put(name, picture::beside(both));
}

auto all_points(const fs::path& path) -> std::vector<formats::CloudPoint> {
  const auto cloud = need(formats::open_points(path));
  std::vector<formats::CloudPoint> points;
  for (std::size_t i = 0; i < cloud->pieces(); ++i) std::ranges::copy(need(cloud->read(i)), std::back_inserter(points));
  return points;
}

/// Points beside the models that are made of them.
void clouds(const Figures& to, pipeline::Options options) {
  const picture::View view{.kind = picture::View::Kind::angle, .azimuth = 0.6, .width = 480, .height = 350};
  const picture::View flat{.kind = picture::View::Kind::angle, .azimuth = 0.5, .width = 500, .height = 230};
  const auto all = [](const formats::CloudPoint&) { return true; };
  auto houses = options;
  houses.ingest.bbox = {84868, 447538, 84880, 447548};  // as in the tutorial
  const auto delft = all_points(to.data / "delft/points.laz");
  const auto footprints = to.data / "delft/footprints.geojson";
  points_and_models(to, "cloud.png", delft, footprints, houses, all, 0.15, 2, view);
  points_and_models(
      to, "cloud-buildings.png", delft, footprints, houses, [](const auto& p) { return p.classification == 6; }, 0.15,
      2, view);
  // The corners of the hall's mesh, as the tutorial has them: a cloud without classes.
  const auto hall = need(ingest::read_scene({to.data / "hall/mesh.off"}, to.data / "hall/footprints.geojson", {}));
  std::vector<formats::CloudPoint> corners;
  const auto& origin = hall.frame.origin;
  for (const auto& v : hall.mesh.vertices)
    corners.push_back({.position = v + geometry::Point3{double(origin[0]), double(origin[1]), double(origin[2])}});
  points_and_models(
      to, "cloud-half.png", corners, to.data / "hall/footprints.geojson", options,
      [](const auto& p) { return p.position.x < -285; }, 0.6, 10, flat);
}

}  // namespace

auto main(int count, char** words) -> int {
  if (count != 3) return std::fputs("usage: site_figures DATA OUTDIR\n", stderr), 2;
  const Figures to{words[1], words[2]};
  fs::create_directories(to.out);
  pipeline::Options options;
  const auto hall =
      need(ingest::read_scene({to.data / "hall/mesh.off"}, to.data / "hall/footprints.geojson", options.ingest));
  auto moved = options.ingest;
  moved.mesh_offset = {84800, 447400, 0};
  const auto delft =
      need(ingest::read_scene({to.data / "delft/mesh.ply"}, to.data / "delft/footprints.geojson", moved));
  polygons(to);
  program(to);
  rooms_in_plan(to, delft, options);
  surfaces(to, hall, options);
  derived(to, delft);
  measured_planes(to, options);
  clouds(to, options);
}
