#include "apps/server/project.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/server/json.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

constexpr int format = 1;
constexpr const char* kind = "mansard-project";
constexpr const char *project_file = "project.json", *run_file = "run.json";

/// Paths inside the project are relative to it, so that its folder can be moved. Passwords are removed.
auto from_project(const fs::path& folder, const std::string& name) -> std::string {
  if (name.empty() || !formats::is_disk_name(name)) return formats::name_to_keep(name);
  const auto relative = fs::path(name).lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." ? name : relative.string();
}

auto to_project(const fs::path& folder, const std::string& name) -> std::string {
  return name.empty() || !formats::is_disk_name(name) ? name : (folder / name).string();
}

auto files_json(const fs::path& folder, const std::vector<KnownFile>& files) -> Json {
  Json out = Json::array();
  for (const auto& file : files)
    out.push_back({{"path", from_project(folder, file.path)},
                   {"bytes", file.bytes},
                   {"sha256", file.sha256},
                   {"bytes_on_disk", file.stamp.bytes},
                   {"modified_ns", file.stamp.modified}});
  return out;
}

auto files_of(const fs::path& folder, const Json& json) -> std::vector<KnownFile> {
  std::vector<KnownFile> files;
  for (const auto& file : json) {
    const auto bytes = file.at("bytes").get<std::uint64_t>();
    const Stamp stamp{file.value("bytes_on_disk", bytes), file.at("modified_ns").get<std::int64_t>()};
    files.push_back(
        {to_project(folder, file.at("path").get<std::string>()), bytes, file.at("sha256").get<std::string>(), stamp});
  }
  return files;
}

/// The options with the path of the terrain, the only option that is a path, converted by `named`.
auto with_terrain(Texts reading, const fs::path& folder, std::string (*named)(const fs::path&, const std::string&))
    -> Texts {
  if (const auto terrain = reading.find(terrain_option); terrain != reading.end())
    terrain->second = named(folder, terrain->second);
  return reading;
}

auto inputs_json(const fs::path& folder, const Inputs& inputs) -> Json {
  Json meshes = Json::array();
  for (const auto& mesh : inputs.meshes) meshes.push_back(from_project(folder, mesh));
  return {{"meshes", meshes},
          {"footprints", from_project(folder, inputs.footprints)},
          {"reading", with_terrain(inputs.reading, folder, from_project)},
          {"mesh_files", files_json(folder, inputs.mesh_files)},
          {"terrain_files", files_json(folder, inputs.terrain_files)},
          {"footprint_files", files_json(folder, inputs.footprint_files)}};
}

auto inputs_of(const fs::path& folder, const Json& json) -> Inputs {
  Inputs inputs;
  for (const auto& mesh : json.at("meshes")) inputs.meshes.push_back(to_project(folder, mesh.get<std::string>()));
  inputs.footprints = to_project(folder, json.at("footprints").get<std::string>());
  inputs.reading = with_terrain(json.at("reading").get<Texts>(), folder, to_project);
  inputs.mesh_files = files_of(folder, json.at("mesh_files"));
  if (json.contains("terrain_files")) inputs.terrain_files = files_of(folder, json.at("terrain_files"));
  inputs.footprint_files = files_of(folder, json.at("footprint_files"));
  return inputs;
}

auto record_json(const RunRecord& run) -> Json {
  Json out = json_of(run, 0);
  out.erase("edits");  // they are in the journal
  out["version"] = format;
  Json maps = Json::array();
  for (const auto& map : run.maps) maps.push_back(json_of(map));
  out["maps"] = maps;
  return out;
}

auto diagnostic_of(const Json& json) -> base::Diagnostic {
  return {json.at("severity") == "error" ? base::Severity::error : base::Severity::warning,
          json.at("code").get<std::string>(), json.at("message").get<std::string>(),
          json.at("subject").get<std::string>()};
}

auto spent_of(const Json& json) -> base::Spent { return {json.at("cpu_seconds"), json.at("wall_seconds"), {}}; }

/// Runs of earlier versions have a list of elapsed times.
auto times_of(const Json& json) -> report::Times {
  report::Times times;
  if (json.is_array()) {
    for (const auto& stage : json) {
      times.stages.push_back({stage.at("stage"), {0, stage.at("seconds"), {}}});
      times.total.wall_seconds += times.stages.back().spent.wall_seconds;
    }
    return times;
  }
  times.total = spent_of(json);
  for (const auto& stage : json.at("stages")) times.stages.push_back({stage.at("stage"), spent_of(stage)});
  return times;
}

auto record_of(const Json& json) -> RunRecord {
  RunRecord run;
  if (json.at("version") != format) throw std::runtime_error("it was written by another version of mansard");
  run.id = json.at("id").get<std::string>();
  run.label = json.at("label").get<std::string>();
  run.state = state_of(json.at("state").get<std::string>()).value_or(State::failed);
  if (!json.at("failure").is_null()) run.failure = diagnostic_of(json.at("failure"));
  run.created = json.at("created").get<std::string>();
  run.preset = json.at("preset").get<std::string>();
  run.options = json.at("options").get<Texts>();
  run.blocks = json.at("blocks").get<std::vector<std::string>>();
  if (const auto& s = json.at("scores"); !s.is_null())
    run.scores = RunScores{s.at("mse"),        s.at("footprint_mse"), s.at("footprint_median_absolute"),
                           s.at("inside_mse"), s.at("missed"),        s.at("invented")};
  run.times = times_of(json.at("times"));
  run.buildings = json.at("buildings");
  run.full = json.at("full");
  run.parts = json.at("parts");
  run.faces = json.at("faces");
  for (const auto& map : json.at("maps"))
    run.maps.push_back({map.at("block"),
                        {map.at("origin").at(0), map.at("origin").at(1)},
                        map.at("grid"),
                        map.at("columns"),
                        map.at("rows")});
  return run;
}

/// 3 for "run-3", and for "run-3-2" in the trash.
auto number_of(const std::string& name) -> std::optional<std::int64_t> {
  if (!name.starts_with("run-")) return std::nullopt;
  const auto number = base::to_integer(std::string_view(name).substr(4, name.find('-', 4) - 4));
  return number && *number > 0 ? number : std::nullopt;
}

auto run_numbers(const fs::path& folder) -> std::vector<std::int64_t> {
  std::vector<std::int64_t> numbers;
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(folder, status))
    if (const auto number = number_of(entry.path().filename().string())) numbers.push_back(*number);
  std::ranges::sort(numbers);
  return numbers;
}

auto unreadable(const std::string& why, const fs::path& path) -> base::Diagnostic {
  return base::error("server-project",
                     "this file of the project cannot be read: " + why + "; restore it from a backup, or move it away",
                     path.string());
}

/// One damaged run does not keep the others from being opened.
auto read_run_record(const fs::path& path, const std::string& id) -> RunRecord {
  std::string why;
  if (const auto text = base::read_file(path); !text) {
    why = text.error().message;
  } else {
    try {
      auto run = record_of(Json::parse(*text));
      run.id = id;
      return run;
    } catch (const std::exception& e) {
      why = e.what();
    }
  }
  RunRecord run;
  run.id = run.label = id;
  run.state = State::failed;
  run.damaged = true;
  run.failure = base::error("server-damaged",
                            "the record of this run cannot be read: " + base::on_one_line(why) +
                                "; restore the file from a backup and start the server again, or delete the run",
                            path.string());
  return run;
}

/// Whether the folder is empty except for what an interrupted first start leaves: the lock and temporary files.
auto is_unused(const fs::path& folder) -> bool {
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(folder, status)) {
    const auto name = entry.path().filename().string();
    const bool own = name == "lock" || (name.starts_with(".project.json.") && name.ends_with(".part"));
    if (!own) return false;
  }
  return !status;
}

auto make_parents(const fs::path& folder) -> base::Result<void> {
  std::error_code status;
  if (fs::is_directory(folder, status)) return {};
  fs::create_directories(folder, status);
  if (!status) return {};
  return base::error("file-write", "cannot make this folder: " + status.message() + "; choose a writable folder",
                     folder.string());
}

auto lock_of(const fs::path& folder) -> base::Result<Descriptor> {
  const auto path = folder / "lock";
  Descriptor lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (!lock.is_open())
    return base::error(
        "file-write",
        std::string("cannot write into this folder: ") + std::strerror(errno) + "; choose a writable folder",
        folder.string());
  if (::flock(lock.number(), LOCK_EX | LOCK_NB) != 0)
    return base::error("server-locked",
                       "the project is open in another 'mansard serve'; use its page, or stop it first",
                       folder.string());
  return lock;
}

}  // namespace

auto Inputs::same_request(const Inputs& other) const -> bool {
  return meshes == other.meshes && reading == other.reading &&
         formats::name_to_keep(footprints) == formats::name_to_keep(other.footprints);
}

auto stamp_of(const fs::path& path) -> std::optional<Stamp> {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return Stamp{static_cast<std::uint64_t>(status.st_size),
               status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec};
}

auto unknown_run(const std::string& run) -> base::Diagnostic {
  return base::error("server-unknown", "unknown run; it may have been deleted", run);
}

auto journal_of(const fs::path& run_folder) -> fs::path { return run_folder / "journal.jsonl"; }

auto read_journal(const fs::path& journal) -> base::Result<std::string> {
  if (std::error_code status; !fs::exists(journal, status)) return std::string();
  return base::read_file(journal);
}

Project::Project(fs::path folder, Descriptor lock) : folder_(std::move(folder)), lock_(std::move(lock)) {}

auto Project::open(const fs::path& given) -> base::Result<Project> {
  std::error_code status;
  auto folder = fs::absolute(given, status).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "project/"
  if (fs::exists(folder, status) && !fs::is_directory(folder, status))
    return base::error("server-folder", "a project is a folder, but this is a file; give another name",
                       folder.string());
  const bool is_project = fs::exists(folder / project_file, status);
  if (!is_project && fs::exists(folder, status) && !is_unused(folder))
    return base::error(
        "server-folder",
        "the folder is not empty and not a mansard project; give a project's folder, an empty folder or a new name",
        folder.string());
  if (auto made = make_parents(folder); !made) return made.error();
  auto lock = lock_of(folder);
  if (!lock) return lock.error();
  Project project(folder, std::move(*lock));
  if (fs::exists(folder / project_file, status)) {
    if (auto read = project.read(); !read) return read.error();
  } else {
    const Json fresh{{"type", kind}, {"version", format}, {"inputs", nullptr}};
    if (auto written = write_durably(folder / project_file, text_of(fresh) + "\n"); !written) return written.error();
  }
  for (const auto* name : {"inputs", "runs", "exports", "trash"})
    if (auto made = make_folder(folder / name); !made) return made.error();
  return project;
}

auto Project::read() -> base::Result<void> {
  const auto path = folder_ / project_file;
  const auto text = base::read_file(path);
  if (!text) return text.error();
  try {
    const auto json = Json::parse(*text);
    if (json.at("type") != kind) return unreadable("it is not a mansard project", path);
    if (json.at("version") != format) return unreadable("it was written by another version of mansard", path);
    if (!json.at("inputs").is_null()) inputs_ = inputs_of(folder_, json.at("inputs"));
  } catch (const Json::exception& e) {
    return unreadable(e.what(), path);
  }
  return {};
}

auto Project::name() const -> std::string { return folder_.filename().string(); }

auto Project::save(const Inputs& inputs) -> base::Result<void> {
  const Json json{{"type", kind}, {"version", format}, {"inputs", inputs_json(folder_, inputs)}};
  if (auto written = write_durably(folder_ / project_file, text_of(json) + "\n"); !written) return written;
  inputs_ = inputs;
  return {};
}

auto Project::runs() -> base::Result<std::vector<RunRecord>> {
  std::vector<RunRecord> runs;
  for (const auto number : run_numbers(folder_ / "runs")) {
    const auto path = folder_ / "runs" / ("run-" + std::to_string(number)) / run_file;
    std::error_code status;
    if (!fs::exists(path, status)) continue;
    runs.push_back(read_run_record(path, "run-" + std::to_string(number)));
    if (over(runs.back().state)) continue;
    runs.back().state = State::interrupted;
    if (auto saved = save(runs.back()); !saved) return saved.error();
  }
  return runs;
}

auto Project::new_run() -> base::Result<std::string> {
  std::int64_t last = 0;
  for (const auto* place : {"runs", "trash"})
    for (const auto number : run_numbers(folder_ / place)) last = std::max(last, number);
  auto id = "run-" + std::to_string(last + 1);
  if (auto made = make_folder(run_folder(id)); !made) return made.error();
  return id;
}

auto Project::save(const RunRecord& run) -> base::Result<void> {
  return write_durably(run_folder(run.id) / run_file, text_of(record_json(run)) + "\n");
}

auto Project::run_folder(const std::string& run) const -> fs::path { return folder_ / "runs" / run; }

auto Project::trash(const std::string& run) -> base::Result<void> {
  return move_durably(run_folder(run), folder_ / "trash" / run);
}

auto Project::applied_edits(const std::string& run) const -> std::size_t {
  const auto journal = read_journal(journal_of(run_folder(run)));
  return journal ? edit::applied_edits(*journal) : 0;
}

}  // namespace mansard::server
