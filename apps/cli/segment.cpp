// `mansard segment MESH… FOOTPRINTS -o OUT.gpkg`: why walls are where they are.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/report/layers.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using NamedBytes = std::vector<std::pair<fs::path, std::string>>;

struct SegmentRequest {
  ScanRequest scan;
  std::string out, mps;
};

/// Of two outputs with one path only the last would be left. The report is checked too.
auto check_apart(const SegmentRequest& request, std::vector<fs::path> files) -> base::Result<void> {
  if (!request.scan.report.empty()) files.emplace_back(request.scan.report);
  std::set<fs::path> taken;
  for (const auto& file : files) {
    std::error_code status;
    const auto place = fs::weakly_canonical(fs::absolute(file, status), status);
    if (!status && !taken.insert(place).second)
      return base::error("usage", "two outputs have this path; choose different paths", file.string());
  }
  return {};
}

/// Names of programs are known when the blocks are: those of an earlier run are found before the work all the same.
auto programs_free(const SegmentRequest& request) -> base::Result<void> {
  if (request.mps.empty() || request.scan.overwrite) return {};
  const fs::path path = request.mps;
  const auto start = path.stem().string() + "-block-", end = path.extension().string();
  std::error_code failure;
  for (fs::directory_iterator at(path.has_parent_path() ? path.parent_path() : ".", failure), none;
       !failure && at != none; at.increment(failure)) {
    const auto name = at->path().filename().string();
    if (name.size() > start.size() + end.size() && name.starts_with(start) && name.ends_with(end))
      return base::error("output-exists",
                         "an integer program of an earlier run is there; choose another name, or add --overwrite",
                         (path.parent_path() / name).string());
  }
  return {};
}

auto check_outputs(const SegmentRequest& request) -> base::Result<void> {
  if (fs::path(request.out).extension() != ".gpkg")
    return base::error("usage", "the output is a GeoPackage; its file extension must be .gpkg", request.out);
  std::vector<fs::path> files{request.out};
  if (!request.mps.empty()) files.emplace_back(request.mps);
  if (auto apart = check_apart(request, files); !apart) return apart;
  if (auto usable = files_free(request.scan, std::move(files)); !usable) return usable;
  return programs_free(request);
}

/// The programs of the blocks with faces inside. One takes the name that was given; several have the block's in it.
auto programs(const SegmentRequest& request, const report::Segmented& result) -> base::Result<NamedBytes> {
  std::vector<const report::SegmentedBlock*> blocks;
  for (const auto& block : result.segmented)
    if (block.segmentation && std::ranges::any_of(block.segmentation->faces, &segment::FaceEvidence::inside))
      blocks.push_back(&block);
  NamedBytes files;
  std::vector<fs::path> names, results{request.out};
  for (const auto* block : blocks) {
    fs::path path = request.mps;
    if (blocks.size() > 1) path.replace_filename(path.stem().string() + "-" + block->name + path.extension().string());
    auto text = solver::mps(segment::program_of(*block->segmentation), block->name);
    if (!text)
      return base::error(text.error().code, text.error().message + "; lower the weights of the module segment",
                         block->name);
    names.push_back(path);
    files.emplace_back(std::move(path), std::move(*text));
  }
  results.insert(results.end(), names.begin(), names.end());
  if (auto apart = check_apart(request, std::move(results)); !apart) return apart.failure();
  if (auto usable = files_free(request.scan, std::move(names)); !usable) return usable.failure();
  return files;
}

auto total(const std::vector<report::BlockReport>& blocks, std::size_t report::BlockReport::*member) -> std::size_t {
  std::size_t sum = 0;
  for (const auto& block : blocks) sum += block.*member;
  return sum;
}

auto with_status(const std::vector<report::BlockReport>& blocks, std::string_view status) -> std::string {
  return std::to_string(std::ranges::count(blocks, status, &report::BlockReport::status));
}

void say_terms(const std::vector<report::BlockReport>& blocks, Progress& progress) {
  segment::Terms sum;
  for (const auto& block : blocks) sum += block.terms;
  const auto amount = [](double cost) { return base::to_text(cost, 1); };
  std::string text = "objective " + amount(sum.sum());
  const char* before = ": ";
  for (const auto& info : segment::terms()) {
    text += before + std::string(info.words) + " " + amount(sum[info.term]);
    before = ", ";
  }
  progress.say(text);
}

void summarise(const report::Segmented& result, const SegmentRequest& request, Progress& progress) {
  using report::BlockReport;
  const auto& blocks = result.blocks;
  const auto count = [&](std::size_t BlockReport::*member) { return std::to_string(total(blocks, member)); };
  progress.say(std::to_string(blocks.size()) + (blocks.size() == 1 ? " block: " : " blocks: ") +
               count(&BlockReport::sweep_edges) + " sweep-edges, " + count(&BlockReport::faces) + " faces, " +
               count(&BlockReport::variables) + " variables, " + count(&BlockReport::parts) + " parts");
  say_terms(blocks, progress);
  double gap = 0;
  for (const auto& block : blocks) gap = std::max(gap, relative_gap(block));
  progress.say(with_status(blocks, "optimal") + " of " + std::to_string(blocks.size()) + " blocks proven optimal, " +
               with_status(blocks, "stopped") + " stopped, " + with_status(blocks, "empty") + " empty, " +
               with_status(blocks, "failed") + " failed; the largest gap is " + base::to_text(100 * gap, 3) + " %");
  if (request.scan.verbose || result.warnings.size() <= 20)
    for (const auto& warning : result.warnings) progress.say(base::to_string(warning));
}

auto write_all(const SegmentRequest& request, const report::Segmented& result, const model::Scene& scene,
               const NamedBytes& mps, const base::Run& run) -> base::Result<void> {
  const auto layers = formats::geopackage(report::segment_layers(scene, result.segmented, result.made_by), scene.frame);
  if (!layers) return layers.failure();
  const std::string report = report::run_json(result, scene);
  std::vector<base::FileToWrite> files{{request.out, *layers}};
  for (const auto& [path, bytes] : mps) files.push_back({path, bytes});
  if (!request.scan.report.empty()) files.push_back({request.scan.report, report});
  return base::write_files(files, run.cancel);
}

auto segment_scan(const SegmentRequest& request, const base::Cancel& cancel) -> int {
  auto options = options_of(request.scan);
  if (!options) return give_up(options.errors());
  if (auto ready = check_outputs(request); !ready) return give_up(ready.errors());
  Progress progress(request.scan.quiet);
  const auto run = start(request.scan, options->seed, cancel, progress);
  const auto scene = read_scan(request.scan, *options, run, progress);
  if (!scene) return give_up(scene.errors());
  const auto result = pipeline::segment(*scene, *options, run);
  if (!result) return give_up(result.errors());
  const auto mps = request.mps.empty() ? NamedBytes{} : programs(request, *result);
  if (!mps) return give_up(mps.errors());
  progress.show("write", request.out, 1);
  if (auto written = write_all(request, *result, *scene, *mps, run); !written) return give_up(written.errors());

  summarise(*result, request, progress);
  const auto parts = report::parts_by_feature(*scene, result->segmented);
  const auto without = std::ranges::count(parts, 0U);
  if (without > 0)
    progress.say(
        std::to_string(without) + " of " + std::to_string(parts.size()) +
        " footprints have no part of their own; see the columns 'parts' and 'defect' of the layer gis_footprints");
  if (!request.mps.empty() && mps->empty())
    progress.say("no block has a face inside a footprint, so there is no integer program to export");
  std::printf("%s\n", request.out.c_str());
  for (const auto& [path, bytes] : *mps) std::printf("%s\n", path.c_str());
  return without == 0 ? all_done : some_fell_back;
}

}  // namespace

auto segment_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "segment");
  auto request = std::make_shared<SegmentRequest>();
  add_to(*verb, request->scan);
  request->scan.words = std::move(words);
  verb->add_option("-o,--output", request->out, "Output GeoPackage")->required()->type_name("OUT.gpkg");
  verb->add_option("--export-mps", request->mps, "Also write the integer program as MPS, one file for each block")
      ->type_name("FILE");
  return {verb, [request, &cancel] { return segment_scan(*request, cancel); }};
}

}  // namespace mansard::cli
