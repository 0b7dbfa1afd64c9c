// `mansard convert MODEL -o OUT`: models that mansard wrote in any other format that it writes, and CityJSON of other
// producers in those that need no plans.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/formats.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/stored.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertRequest : Common {
  std::string input, to;
  std::vector<std::string> outs;
};

auto targets_of(const ConvertRequest& request) -> base::Result<std::vector<Target>> {
  std::vector<Target> targets;
  if (!request.to.empty() && request.outs.size() != 1)
    return base::error("usage", "--to is for one output; with several, the file extension of each names its format",
                       "--to");
  for (const auto& out : request.outs) {
    if (request.to.empty()) {
      auto target = target_at(out);
      if (!target) return target.failure();
      targets.push_back(std::move(*target));
    } else {
      const auto format = format_named(request.to);
      if (!format) return format.failure();
      targets.push_back({*format, out});
    }
  }
  return targets;
}

auto check_outputs(const ConvertRequest& request, const std::vector<Target>& targets) -> base::Result<void> {
  std::vector<fs::path> places;
  for (const auto& target : targets)
    for (const auto& place : formats::is_database_name(target.path) ? std::vector<fs::path>() : places_of(target)) {
      if (auto apart = spare_results(place, places); !apart) return apart;
      places.push_back(place);
    }
  if (auto spared = spare_inputs(places, {request.input}); !spared) return spared;
  for (const auto& target : targets)
    if (auto usable = target_free(target, request.overwrite); !usable) return usable;
  return {};
}

/// What can be done with a file that has no plans in it.
auto explained(base::Diagnostic why, const std::string& input) -> base::Diagnostic {
  if (pipeline::is_foreign(why))
    why.message +=
        "; only models that mansard wrote, CityJSON and CityGML can be converted. 'mansard evaluate' measures other "
        "producers' "
        "OBJ, 'mansard extrude " +
        base::on_one_line(input) + "' extrudes the footprints of a vector file";
  return why;
}

/// Whether a format has more of a face than its corners and its class.
auto tells_of_faces(const Target& target) -> bool {
  using enum formats::Format;
  return target.format == glb || target.format == tiles || target.format == geopackage;
}

/// Whether a reader's solids are all that a format takes: those of buildings or of single parts, by their corners and
/// classes.
auto is_enough(const formats::CityReader& reader, const Target& target, const formats::WriteOptions& options) -> bool {
  using enum formats::Format;
  if (tells_of_faces(target)) return false;
  switch (target.format) {
    case plans:
    case geojson:
    case flatgeobuf: return reader.has_models() || reader.has_solids();
    case stl:
      return options.stl_shell == formats::Shell::part
                 ? reader.has_models()
                 : options.stl_shell == formats::Shell::building && reader.has_solids();
    case citygml: return reader.has_solids();
    default: return options.solids == formats::Solids::part ? reader.has_models() : reader.has_solids();
  }
}

/// One building after the other to all targets: memory does not grow with their number. As formats::write_each, but
/// reads once.
auto pass_on(formats::CityReader& reader, const std::vector<Target>& targets, const formats::Header& header,
             const formats::WriteOptions& options, const std::vector<formats::Layer>& layers, base::Outputs& outputs,
             const base::Run& run) -> base::Result<formats::Written> {
  formats::Written out;
  struct Open {
    const Target* target = nullptr;
    std::unique_ptr<base::Outputs> outputs;
    std::unique_ptr<formats::CityWriter> writer;
  };
  std::vector<Open> open;
  for (const auto& target : targets) {
    auto own = std::make_unique<base::Outputs>();
    auto writer = formats::open_writer(target.format, target.path, header, options, *own, layers);
    if (writer) open.push_back({&target, std::move(own), std::move(*writer)});
    else out.missing.push_back({target, writer.error()});
  }
  const auto each = [&](auto step) {
    std::erase_if(open, [&](Open& one) {
      const base::Result<void> done = step(*one.writer);
      if (!done) out.missing.push_back({*one.target, done.error()});
      return !done;
    });
  };
  while (!open.empty()) {
    if (run.cancelled()) return base::stopped();
    const auto building = reader.next();
    if (!building) return building.failure();
    if (!*building) break;
    each([&](formats::CityWriter& writer) { return writer.add(**building); });
  }
  each([](formats::CityWriter& writer) { return writer.finish(); });
  if (open.empty()) return out.missing.front().why;
  for (auto& one : open) {
    std::ranges::move(one.writer->warnings(), std::back_inserter(out.warnings));
    one.writer.reset();
    outputs.take(std::move(*one.outputs));
  }
  return out;
}

/// The files take their places; what is there is named, and then what is not.
auto finish(const formats::Written& written, const ConvertRequest& request, const std::vector<Target>& targets,
            base::Outputs& outputs, const base::Run& run, Progress& progress) -> int {
  for (const auto& warning : written.warnings) progress.say(base::to_string(warning));
  if (auto committed = outputs.commit(run.cancel); !committed) return give_up(committed.errors());
  for (const auto& target : targets)
    if (std::ranges::none_of(written.missing, [&](const auto& one) { return one.target.path == target.path; }))
      std::printf("%s\n", formats::name_to_show(target.path).c_str());
  if (written.missing.empty()) return all_done;
  return give_up(reasons_of(written.missing, {{formats::Format::plans, request.input}}));
}

/// CityJSON, CityJSONSeq and CityGML by their names, which other producers' files have too.
auto may_be_city_model(const std::string& input) -> bool {
  const std::string name = base::lower(fs::path(input).filename().string());
  return name.ends_with(".json") || name.ends_with(".jsonl") || name.ends_with(".cityjson") ||
         name.ends_with(".cityjsonl") || name.ends_with(".gml") || name.ends_with(".citygml") || name.ends_with(".xml");
}

/// Models of another producer, as they are.
auto convert_foreign(const ConvertRequest& request, const std::vector<Target>& targets, const base::Cancel& cancel)
    -> int {
  for (const auto& target : targets)
    if (!formats::takes_foreign(target.format))
      return give_up(
          base::error("usage",
                      "this format needs plans, which models of other producers do not have; choose OBJ, GLB, "
                      "3D Tiles, GeoPackage, STL, CityGML, DXF or FlatGeobuf",
                      target.path.string()));
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request, targets); !ready) return give_up(ready.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);
  auto foreign = formats::read_foreign(request.input);
  if (!foreign) return give_up(foreign.errors());
  for (const auto& warning : foreign->warnings) progress.say(base::to_string(warning));
  progress.say(std::to_string(foreign->city.buildings.size()) + " buildings of another producer, LoD " + foreign->lods);
  base::Outputs outputs;
  const auto written = formats::write_models(foreign->city, targets, options.write, outputs);
  if (!written) return give_up(written.errors());
  return finish(*written, request, targets, outputs, run, progress);
}

auto convert(const ConvertRequest& request, const base::Cancel& cancel) -> int {
  const auto targets = targets_of(request);
  if (!targets) return give_up(targets.errors());
  auto reader = open_city(request.input);
  if (!reader && pipeline::is_foreign(reader.error()) && may_be_city_model(request.input))
    return convert_foreign(request, *targets, cancel);
  if (!reader) return give_up(explained(reader.error(), request.input));
  formats::Header header = (*reader)->header();
  pipeline::Options options;
  auto warnings = pipeline::take_options(header.made_by, options);
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (auto ready = check_outputs(request, *targets); !ready) return give_up(ready.errors());

  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);
  for (const auto& warning : warnings) progress.say(base::to_string(warning));
  auto beside = layers_beside(**reader, request.input, *targets);
  if (!beside) return give_up(beside.errors());
  for (const auto& warning : beside->warnings) progress.say(base::to_string(warning));
  base::Outputs outputs;
  base::Result<formats::Written> written{formats::Written()};
  bool all_full = true;
  const bool has_all =
      std::ranges::all_of(*targets, [&](const Target& target) { return is_enough(**reader, target, options.write); });
  if (has_all && pipeline::same_options(header.made_by, options)) {
    written = pass_on(**reader, *targets, header, options.write, beside->layers, outputs, run);
  } else {
    progress.show("extrude", request.input, 0);
    const auto raised = pipeline::read_raised(**reader, options, run);
    if (!raised) return give_up(raised.errors());
    for (const auto& part : raised->fell_short)
      for (const auto& reason : part.reasons) progress.say(base::to_string(reason));
    for (const auto& part : raised->refused) std::fprintf(stderr, "mansard: %s\n", base::to_string(part).c_str());
    for (const auto& remark : raised->remarks) progress.say(base::to_string(remark));
    all_full = raised->fell_short.empty() && raised->refused.empty();
    written = write_models(raised->city, *targets, options.write, outputs, beside->layers);
  }
  if (!written) return give_up(written.errors());
  const int code = finish(*written, request, *targets, outputs, run, progress);
  return code == all_done && !all_full ? some_fell_back : code;
}

}  // namespace

auto convert_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "convert");
  auto request = std::make_shared<ConvertRequest>();
  verb->add_option(
          "INPUT", request->input,
          "Model that mansard wrote: " + readable_formats().own_models + "; or CityJSON or CityGML of any producer")
      ->required()
      ->type_name("MODEL");
  verb->add_option("-o,--output", request->outs,
                   "Output, with its format by its file extension (" + extensions() +
                       "), or a database (PG:...); may be given several times")
      ->required()
      ->expected(1, 1000)
      ->allow_extra_args(false)
      ->type_name("OUT");
  verb->add_option("--to", request->to, "Format of the output, if its file extension does not name it")
      ->type_name("FORMAT");
  add_common(*verb, *request, "warnings");
  return {verb, [request, &cancel] { return convert(*request, cancel); }};
}

}  // namespace mansard::cli
