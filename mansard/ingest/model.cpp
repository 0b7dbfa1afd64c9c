// The steps of reading a model: its bytes, its format, one frame, and the removal of faults.
#include "mansard/ingest/model.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/model_crs.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/models.hpp"
#include "mansard/ingest/detail/by_normal.hpp"
#include "mansard/ingest/detail/clean.hpp"
#include "mansard/ingest/detail/mesh_files.hpp"
#include "mansard/ingest/detail/origin.hpp"

namespace mansard::ingest {
namespace {

using geometry::Box3;
using geometry::Point2;
using geometry::Point3;

constexpr double farthest = 1e8;  // m; a coordinate beyond is as good as infinite

auto usable(Point3 p) -> bool {
  return std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest;  // false for NaN
}

auto in_words(const Box3& e, const model::Frame& frame) -> std::string {
  const auto range = [&](const char* axis, double least, double most, std::size_t i) {
    const auto at = static_cast<double>(frame.origin[i]);
    return std::string(axis) + " " + base::to_text(least + at, 1) + " to " + base::to_text(most + at, 1);
  };
  return range("x", e.least.x, e.most.x, 0) + ", " + range("y", e.least.y, e.most.y, 1) + ", " +
         range("z", e.least.z, e.most.z, 2);
}

template <class Act>
void each_loop(model::Model& model, Act act) {
  for (auto& building : model.buildings)
    for (auto& part : building.parts)
      for (auto& face : part.faces)
        for (auto& loop : face.loops) act(loop);
}

/// Repeated corners go; a loop without three of them is none.
auto is_sound(std::vector<Point3>& loop) -> bool {
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return loop.size() >= 3 && std::ranges::all_of(loop, usable);
}

/// Takes out what cannot be used; returns how many faces.
auto drop_unusable(std::vector<model::ModelBuilding>& buildings) -> std::size_t {
  std::size_t dropped = 0;
  for (auto& building : buildings) {
    for (auto& part : building.parts) {
      dropped += std::erase_if(part.faces, [](model::ModelFace& face) {
        if (face.loops.empty() || !is_sound(face.loops.front())) return true;
        const auto holes = face.loops.begin() + 1;
        face.loops.erase(std::remove_if(holes, face.loops.end(), [](auto& hole) { return !is_sound(hole); }),
                         face.loops.end());
        return geometry::length(model::area_vector(face.loops.front())) < 1e-9;
      });
    }
    std::erase_if(building.parts, [](const model::ModelPart& part) { return part.faces.empty(); });
  }
  std::erase_if(buildings, [](const model::ModelBuilding& building) { return building.parts.empty(); });
  return dropped;
}

void shift(model::Model& model, Point3 by) {
  each_loop(model, [&](auto& loop) {
    for (auto& p : loop) p = p + by;
  });
}

auto is_obj(const std::filesystem::path& path) -> bool { return base::lower(path.extension().string()) == ".obj"; }

/// The CRS to work in: the model's own, unless the user says there is none, or names it where the model does not.
auto working_crs(const std::string& spelt, const std::string& option, const std::string& subject)
    -> base::Result<std::string> {
  if (option == "local") return std::string();
  auto own = crs::plane_crs(spelt, subject);
  if (!own || option.empty()) return own;
  auto asked = crs::plane_crs(option, "ingest.crs");
  if (!asked || own->empty() || crs::same_crs(*own, *asked)) return asked;
  return base::error("ingest-model-crs",
                     "the model is in " + *own + " and --crs says " + *asked +
                         "; a model is never projected: convert one of them, or say --crs local",
                     subject);
}

auto read(const std::filesystem::path& path, const ModelOptions& options) -> base::Result<model::Model> {
  const std::string subject = path.string();
  const auto bytes = base::read_file(path);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return base::error("ingest-model-format", "the file is empty; copy or export it again", subject);
  auto raw =
      is_obj(path) ? formats::read_labelled_obj(*bytes, subject) : formats::read_cityjson(*bytes, options.lod, subject);
  if (!raw) return raw.error();
  auto crs = working_crs(raw->crs, options.crs, subject);
  if (!crs) return crs.error();

  model::Model model;
  model.buildings = std::move(raw->buildings);
  model.lod = std::move(raw->lod);
  model.warnings = std::move(raw->warnings);
  model.inputs = {{subject, bytes->size(), formats::sha256(*bytes)}};
  const auto say = [&](const char* code, const std::string& words) {
    model.warnings.push_back(base::warning(code, words, subject));
  };
  if (const auto dropped = drop_unusable(model.buildings); dropped > 0)
    say("ingest-model-face", std::to_string(dropped) + " faces without three corners or without area were left out");
  if (model.buildings.empty())
    return base::error("ingest-model-empty", "there is no building with a surface in it; check LoD and object types",
                       subject);

  std::size_t guessed = 0, faces = 0;
  for (auto& building : model.buildings) {
    guessed += detail::classify_by_normal(building);
    for (const auto& part : building.parts) faces += part.faces.size();
  }
  if (guessed > 0)
    say("ingest-model-semantics", std::to_string(guessed) + " of " + std::to_string(faces) +
                                      " surfaces do not say whether they are wall, roof or ground; told by direction");
  Box3 extent;
  each_loop(model, [&](const auto& loop) {
    for (const auto p : loop) extent.add(p);
  });
  model.frame = {detail::origin_of(extent.plan(), extent), std::move(*crs)};
  const auto& o = model.frame.origin;
  shift(model, {-static_cast<double>(o[0]), -static_cast<double>(o[1]), -static_cast<double>(o[2])});
  return model;
}

auto extent_of(const geometry::Mesh& mesh) -> Box3 { return Box3::of(mesh.vertices); }

}  // namespace

auto read_model(const std::filesystem::path& path, const ModelOptions& options) -> base::Result<model::Model> {
  try {
    return read(path, options);
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "the model does not fit into memory; cut it into tiles", path.string());
  } catch (const std::exception& e) {
    return base::error("ingest-model-format", std::string("cannot be read (") + e.what() + "); check what it is",
                       path.string());
  }
}

auto in_frame(model::Model model, const model::Frame& frame) -> base::Result<model::Model> {
  const std::string subject = model.inputs.empty() ? std::string() : model.inputs.front().path;
  if (!model.frame.crs.empty() && !frame.crs.empty() && !crs::same_crs(model.frame.crs, frame.crs))
    return base::error("ingest-model-crs",
                       "it is in " + model.frame.crs + ", and the rest in " + frame.crs +
                           "; a model is never projected: convert one of them",
                       subject);
  const auto by = [&](std::size_t axis) { return static_cast<double>(model.frame.origin[axis] - frame.origin[axis]); };
  shift(model, {by(0), by(1), by(2)});
  model.frame = frame;
  return model;
}

namespace {

auto read_into(const model::Frame& frame, const std::vector<std::filesystem::path>& paths, const Options& options,
               const base::Run& run) -> base::Result<ScannedMesh> {
  const std::string subject = paths.empty() ? std::string() : paths.front().string();
  run.report("ingest", subject, 0);
  auto reading = detail::MeshReading::open(paths, options, run);
  if (!reading) return reading.error();
  auto files = reading->finish(frame.crs, std::nullopt, run);
  if (!files) return files.error();
  std::array<double, 3> by{};
  for (std::size_t i = 0; i < 3; ++i) by[i] = options.mesh_offset[i] - static_cast<double>(frame.origin[i]);
  auto clean = detail::clean(std::move(files->mesh), by, std::nullopt);
  if (clean.mesh.triangles.empty())
    return base::error("ingest-mesh-unusable", "no triangle can be used; export the mesh again", subject);
  ScannedMesh out;
  out.mesh = std::move(clean.mesh);
  for (const auto c : clean.classes) out.classes.push_back(static_cast<model::SurfaceClass>(c));
  out.counts = clean.counts;
  out.inputs = std::move(files->inputs);
  out.warnings = std::move(files->warnings);
  auto more = detail::warnings_of(out.counts, subject);
  out.warnings.insert(out.warnings.end(), more.begin(), more.end());
  run.report("ingest", subject, 1);
  return out;
}

}  // namespace

auto read_mesh(const std::vector<std::filesystem::path>& paths, const model::Frame& frame, const Options& options,
               const base::Run& run) -> base::Result<ScannedMesh> {
  const std::string subject = paths.empty() ? std::string() : paths.front().string();
  try {
    return read_into(frame, paths, options, run);
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "the mesh does not fit into memory; cut it into tiles", subject);
  } catch (const std::exception& e) {
    return base::error("ingest-mesh-format", std::string("cannot be read (") + e.what() + "); check what it is",
                       subject);
  }
}

auto check_overlap(const geometry::Mesh& first, const geometry::Mesh& second,
                   const std::pair<std::string, std::string>& what, const model::Frame& frame,
                   const std::string& subject) -> base::Result<void> {
  const Box3 a = extent_of(first), b = extent_of(second);
  if (a.overlaps(b)) return {};
  return base::error("ingest-model-overlap",
                     what.first + " and " + what.second + " do not overlap: the " + what.first + " lies in " +
                         in_words(a, frame) + ", the " + what.second + " in " + in_words(b, frame) +
                         (frame.crs.empty() ? "" : " (" + frame.crs.substr(0, frame.crs.find('[')) + ")") +
                         "; check both, and --mesh-offset",
                     subject);
}

}  // namespace mansard::ingest
