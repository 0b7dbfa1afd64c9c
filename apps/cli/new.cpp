// `mansard new PROJECT MESH… FOOTPRINTS`: a project of one's own data, and the commands that come next.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/checks.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/find_inputs.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/shell_word.hpp"
#include "apps/cli/verbs.hpp"
#include "apps/server/inputs.hpp"
#include "apps/server/options.hpp"
#include "apps/server/project.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

constexpr auto options_file = "options.toml", models_folder = "models";

struct NewRequest : Common {
  std::string project;
  std::vector<std::string> inputs;
  bool no_check = false;
};

/// What the file of options proposes besides the values that are set: what users change first.
constexpr std::array proposed{"ingest.id_attribute", "ingest.layer",      "ingest.where",          "ingest.bbox",
                              "ingest.terrain",      "sweep.gamma",       "profile.quality",       "write.lod",
                              "texture.bake",        "terrain.tolerance", "pipeline.survey_source"};

auto command_of(const NewRequest& request, const pipeline::InputPaths& paths) -> std::string {
  std::string command = "mansard reconstruct";
  for (const auto& mesh : paths.meshes) command += " " + quoted(formats::name_to_show(mesh));
  command += " " + (paths.derive_footprints ? "--derive-footprints" : quoted(formats::name_to_show(paths.footprints)));
  const fs::path project = request.project;
  return command + " --config " + quoted((project / options_file).string()) + " -o " +
         quoted((project / models_folder).string()) + " --picture";
}

/// A value as TOML writes it. JSON's strings are strings of TOML.
auto toml_of(const base::Option& option) -> std::string {
  using Kind = base::Option::Kind;
  const auto value = option.get();
  if (option.kind == Kind::flag || ((option.kind == Kind::integer || option.kind == Kind::number) && !value.empty()))
    return value;
  if (option.kind == Kind::string && option.unit == "m") {  // an offset, a box
    std::string array;
    std::istringstream words(value);
    for (std::string word; words >> word;) array += (array.empty() ? "" : ", ") + word;
    return "[" + array + "]";
  }
  return nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A text as comment lines of at most 100 columns.
auto comment(const std::string& text) -> std::string {
  std::string all, line = "#";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > 100) {
      all += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return all + line + "\n";
}

/// Every option that has not its default, and the proposed ones as comments, in a table for each module. `why` says of
/// an option where its value is from.
auto options_text(const NewRequest& request, const FoundInputs& found, pipeline::Options options,
                  const std::map<std::string, std::string>& why) -> std::string {
  std::string text = comment("Options of this project, written by 'mansard new' of mansard " MANSARD_VERSION
                             ". Edit this file as you like; nothing overwrites it. Lines that begin with '#' have no "
                             "effect: remove the '#' before a name to set it. 'mansard options' lists all options.") +
                     "#\n" +
                     comment(
                         "This command reads the file and makes the models. 'mansard serve' does not read it: it "
                         "has the options of [ingest] in its project.json, and all others on its page.") +
                     "#   " + command_of(request, found.paths) + "\n";
  pipeline::Options defaults;
  const auto usual = pipeline::option_lists(defaults);
  const auto lists = pipeline::option_lists(options);
  for (std::size_t m = 0; m < lists.size(); ++m) {
    std::string table;
    for (const auto& option : lists[m].options()) {
      const auto key = lists[m].module() + "." + option.name;
      const bool set = option.get() != usual[m].find(option.name)->get();
      if (!set && std::ranges::find(proposed, key) == proposed.end() && !why.contains(key)) continue;
      std::string meaning = option.meaning;
      if (!option.unit.empty()) meaning += " Unit: " + option.unit + ".";
      if (option.kind == base::Option::Kind::choice) {
        meaning += " Values:";
        for (const auto& choice : option.choices) meaning += (choice == option.choices.front() ? " " : ", ") + choice;
        meaning += ".";
      }
      table += comment(meaning);
      if (const auto reason = why.find(key); reason != why.end()) table += comment(reason->second);
      table += (set ? "" : "# ") + option.name + " = " + toml_of(option) + "\n\n";
    }
    if (!table.empty()) text += "\n[" + lists[m].module() + "]\n" + table.substr(0, table.size() - 1);
  }
  return text;
}

/// What is wrong with the name of the project, before anything is read.
auto check_project(const NewRequest& request) -> base::Result<void> {
  const fs::path project = request.project;
  std::error_code status;
  if (fs::exists(project / "project.json", status))
    return base::error("output-exists",
                       "this is a project already; open it with 'mansard serve " + quoted(request.project) +
                           " --open', or give another name",
                       request.project);
  if (fs::exists(fs::symlink_status(project, status)) &&
      !(fs::is_directory(project, status) && fs::is_empty(project, status)))
    return base::error("output-exists",
                       "a project is a folder of its own, and this name is taken; give the name of a new folder before "
                       "the inputs: mansard new PROJECT MESH... FOOTPRINTS",
                       request.project);
  return {};
}

/// The folder in which the first of the new folders will be.
auto existing_above(const fs::path& project) -> fs::path {
  std::error_code status;
  auto folder = fs::absolute(project, status).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "project/"
  do folder = folder.parent_path();
  while (folder.has_relative_path() && !fs::exists(folder, status));
  return folder;
}

struct Checked {
  pipeline::Options options;
  std::map<std::string, std::string> why;  ///< by option
};

/// Sets the CRS and the offset with which the inputs match.
auto matched(const FoundInputs& found, pipeline::Options options, const base::Run& run, Progress& progress)
    -> base::Result<Checked> {
  progress.say("comparing the mesh with the footprints; this reads all of both (--no-check leaves it out)");
  const auto placing = pipeline::find_placing(found.paths, options, run);
  if (!placing) return placing.failure();
  if (!*placing)
    return base::error("new-match",
                       "mesh and footprints do not match, and neither a CRS nor an offset of the mesh was found that "
                       "makes them: they seem to be of different places, or nothing in the mesh rises above its "
                       "ground. Compare the extents with 'mansard info'; give --crs or --mesh-offset; or make the "
                       "project as it is with --no-check",
                       formats::name_to_show(found.paths.footprints));
  const auto more = pipeline::options_in_words(**placing, options);
  const auto reason = pipeline::reason_in_words(**placing);
  progress.say((more.empty() ? "mesh and footprints match: " : "mesh and footprints match with " + more + ": ") +
               reason);
  Checked out{options, {}};
  const auto compared = "Found by comparing mesh and footprints: " + reason + ".";
  if (!(*placing)->crs.empty()) {
    out.options.ingest.crs = (*placing)->crs;
    out.why["ingest.crs"] = compared;
  }
  if ((*placing)->offset != options.ingest.mesh_offset) {
    out.options.ingest.mesh_offset = (*placing)->offset;
    out.why["ingest.mesh_offset"] = compared;
  }
  if (!out.why.contains("ingest.mesh_offset"))
    out.why["ingest.mesh_offset"] = "None is needed: mesh and footprints match without another one.";
  if (!out.why.contains("ingest.crs") && options.ingest.crs.empty())
    out.why["ingest.crs"] = (*placing)->working.empty()
                                ? "The footprints name none."
                                : "Empty, this is the CRS of the footprints: " +
                                      (*placing)->working.substr(0, (*placing)->working.find('[')) + ".";
  return out;
}

/// Takes away what an unsuccessful attempt made in a folder that was new or empty.
void take_back(const fs::path& project) {
  std::error_code status;
  for (const auto* name : {options_file, "project.json", "lock", "inputs", "runs", "exports", "trash"})
    fs::remove(project / name, status);  // folders only where they are empty
  fs::remove(project, status);
}

auto write(const NewRequest& request, const FoundInputs& found, const Checked& checked) -> base::Result<void> {
  server::InputsRequest asked;
  for (const auto& mesh : found.paths.meshes) asked.meshes.push_back(mesh.string());
  asked.footprints = found.paths.footprints.string();
  auto options = checked.options;
  pipeline::Options defaults;
  const auto usual = pipeline::option_lists(defaults);
  for (const auto& list : pipeline::option_lists(options))
    for (const auto& option : list.options()) {
      const auto key = list.module() + "." + option.name;
      if (!server::is_input_option(key)) continue;
      const auto same = std::ranges::find(usual, list.module(), &base::OptionList::module);
      if (same->find(option.name)->get() != option.get()) asked.reading[key] = option.get();
    }
  const auto inputs = server::requested_inputs(asked, std::nullopt);
  if (!inputs) return inputs.failure();
  auto project = server::Project::open(request.project);
  if (!project) return project.failure();
  if (auto saved = project->save(*inputs); !saved) return saved;
  return base::write_file(fs::path(request.project) / options_file,
                          options_text(request, found, checked.options, checked.why));
}

void tell(const FoundInputs& found, Progress& progress) {
  constexpr std::size_t most = 5;
  const auto& meshes = found.paths.meshes;
  for (std::size_t i = 0; i < std::min(most, meshes.size()); ++i)
    progress.say("mesh: " + formats::name_to_show(meshes[i]));
  if (meshes.size() > most) progress.say("and " + std::to_string(meshes.size() - most) + " more meshes");
  progress.say(found.paths.derive_footprints
                   ? "footprints: none found; they will be derived from the mesh. If you have some, name the file too"
                   : "footprints: " + formats::name_to_show(found.paths.footprints));
  for (const auto& note : found.notes) progress.say("note: " + note);
}

auto make_project(const NewRequest& request, const base::Cancel& cancel) -> int {
  pipeline::Options options;
  if (auto applied = request.settings.apply(options); !applied) return give_up(applied.errors());
  if (request.inputs.empty())
    return give_up(base::error("usage",
                               "expected a mesh or a point cloud, and footprints, or a folder that holds them; run: "
                               "mansard new " +
                                   quoted(request.project) + " MESH... FOOTPRINTS"));
  if (auto usable = check_project(request); !usable) return give_up(usable.errors());
  Progress progress(request.quiet);
  const auto run = start(request, options.seed, cancel, progress);
  auto found = find_inputs(request.inputs);
  if (!found) return give_up(found.errors());
  if (auto spared = spare_inputs({request.project}, found->paths.meshes); !spared) return give_up(spared.errors());
  if (auto usable = can_be_made_in(existing_above(request.project), request.project); !usable)
    return give_up(usable.errors());
  tell(*found, progress);
  for (auto findings : {machine(), libraries()})
    for (const auto& finding : findings)
      if (finding.found == Found::problem) {
        auto line = line_of(finding);
        line.pop_back();
        progress.say(line);
      }
  Checked checked{options, {}};
  if (!found->paths.derive_footprints && !request.no_check) {
    auto match = matched(*found, options, run, progress);
    if (!match) return give_up(match.errors());
    checked = std::move(*match);
  }
  if (auto written = write(request, *found, checked); !written) {
    take_back(request.project);
    return give_up(written.errors());
  }
  progress.say("the project is ready; options are in " + (fs::path(request.project) / options_file).string() +
               ". Run one of these:");
  std::printf("mansard serve %s --open\n%s\n", quoted(request.project).c_str(),
              command_of(request, found->paths).c_str());
  return all_done;
}

}  // namespace

auto new_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "new");
  auto request = std::make_shared<NewRequest>();
  verb->add_option("PROJECT", request->project, "Folder of the new project; it must not exist, or be empty")
      ->required()
      ->type_name("PROJECT");
  verb->add_option("INPUTS", request->inputs,
                   "Meshes or point clouds, and the footprints, in any order; or a folder that holds them")
      ->type_name("MESH... FOOTPRINTS");
  verb->add_flag("--no-check", request->no_check,
                 "Do not compare mesh and footprints, and take the options as they are given");
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print the commands only");
  request->settings.add_to(*verb);
  return {verb, [request, &cancel] { return make_project(*request, cancel); }};
}

}  // namespace mansard::cli
