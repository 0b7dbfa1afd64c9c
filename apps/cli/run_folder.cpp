#include "apps/cli/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/cli/output.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/machine.hpp"
#include "mansard/base/text.hpp"
#include "mansard/base/unfinished.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr auto status_name = "status.json", lock_name = "lock", blocks_name = "blocks";

/// Where what a run keeps is: of a folder in it, of a file beside it.
auto place_in(const fs::path& out, bool file) -> fs::path {
  if (!file) return out / run_folder_name;
  const auto name = out.filename().empty() ? out.parent_path() : out;  // "x.3dtiles/"
  return name.string() + run_folder_name;
}
auto folder_of(const fs::path& out) -> fs::path {
  std::error_code status;
  const auto inside = place_in(out, false), beside = place_in(out, true);
  return fs::exists(inside / status_name, status) || !fs::exists(beside / status_name, status) ? inside : beside;
}

auto read_json(const fs::path& path) -> Json {
  const auto text = base::read_file(path);
  return text ? Json::parse(*text, nullptr, false) : Json();
}

auto text_of(const Json& json, const char* name) -> std::string {
  const auto at = json.find(name);
  return at != json.end() && at->is_string() ? at->get<std::string>() : "";
}

auto number_of(const Json& json, const char* group, const char* name) -> std::int64_t {
  const auto in = json.find(group);
  if (in == json.end() || !in->is_object()) return 0;
  const auto at = in->find(name);
  return at != in->end() && at->is_number() ? at->get<std::int64_t>() : 0;
}

/// Whether somebody holds the lock of a run folder; false where that cannot be known.
auto locked(const fs::path& folder) -> bool {
  const int file = ::open((folder / lock_name).c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool held = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return held;
}

/// Opens and locks; the number of the open file, −1 where somebody else has the lock, or what went wrong.
struct Opened {
  int file = -1;
  int failure = 0;
};
auto open_locked(const fs::path& folder, int how) -> Opened {
  const auto path = folder / lock_name;
  for (;;) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return {-1, errno};
    // The system takes the lock away with the process, however that ends. Where a file system has no locks, a run goes
    // without.
    if (::flock(file, how | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file);
      return {};
    }
    // A run that ends may have removed its folder in between.
    struct stat own {
    }, there{};
    if (::fstat(file, &own) == 0 && ::stat(path.c_str(), &there) == 0 && own.st_ino == there.st_ino) return {file, 0};
    ::close(file);
    std::error_code failure;
    fs::create_directory(folder, failure);
  }
}

auto busy(const fs::path& out, const fs::path& folder) -> base::Diagnostic {
  const Json status = read_json(folder / status_name);
  std::string who = "another run of mansard works";
  if (status.is_object())
    who = "'mansard " + text_of(status, "verb") + "' works there since " + text_of(status, "started") + " (process " +
          std::to_string(number_of(status, "process", "id")) + " on " +
          (status.contains("process") ? text_of(status["process"], "host") : "") + ")";
  return base::error("output-busy", who + "; wait for its end, or choose another output", out.string());
}

auto any_in(const fs::path& blocks) -> bool {
  std::error_code missing;
  return !fs::is_empty(blocks, missing) && !missing;
}

void remove_run_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder / blocks_name, ignored);
  fs::remove(folder / status_name, ignored);
  fs::remove(folder / lock_name, ignored);  // last: who finds none makes one of its own
  fs::remove(folder, ignored);
}

/// That of this process, if it works there alone.
auto current() -> fs::path& {
  static fs::path folder;
  return folder;
}

auto time_in_words(double seconds) -> std::string {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 120) return std::to_string(whole) + " s";
  if (whole < 7200) return std::to_string(whole / 60) + " min";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

}  // namespace

RunFolder::RunFolder(fs::path folder, std::string verb, Use use, int lock, bool empty)
    : folder_(std::move(folder)),
      verb_(std::move(verb)),
      use_(use),
      lock_(lock),
      started_(base::utc_now()),
      empty_(empty),
      begin_(Clock::now()),
      written_(begin_) {}

auto RunFolder::open(const fs::path& out, const std::string& verb, Use use)
    -> base::Result<std::unique_ptr<RunFolder>> {
  const auto folder = place_in(out, use == Use::file);
  std::error_code failure;
  // Files are removed in it: what a link leads to is not this run's.
  for (const auto& own : {folder, folder / blocks_name, folder / lock_name, folder / status_name})
    if (fs::is_symlink(own, failure))
      return base::error("file-write", "this is a link, and a run keeps its work in its output only; remove the link",
                         own.string());
  fs::create_directory(folder, failure);
  const auto unusable = [&](const std::string& why) {
    return base::error("file-write", "cannot write to this folder: " + why + "; choose a path with write permission",
                       folder.string());
  };
  if (failure) return unusable(failure.message());
  const auto lock = open_locked(folder, use == Use::share ? LOCK_SH : LOCK_EX);
  if (lock.failure != 0) return unusable(std::strerror(lock.failure));
  if (lock.file < 0) return busy(out, folder);
  const bool results = use == Use::file ? fs::exists(out, failure) : holds_results(out);
  std::unique_ptr<RunFolder> made(new RunFolder(folder, verb, use, lock.file, !results || began_empty(out)));
  if (use != Use::share)
    for (const auto& entry : fs::directory_iterator(folder, failure))
      if (base::is_part(entry.path())) fs::remove(entry.path(), failure);
  auto kept = pipeline::KeptBlocks::open(folder / blocks_name, use != Use::share);
  if (!kept) return kept.error();
  made->kept_ = std::move(*kept);
  if (use != Use::share) current() = folder;
  made->write("working");
  return made;
}

RunFolder::~RunFolder() {
  if (use_ != Use::share) {
    current().clear();
    const bool nothing = !finished_ && !any_in(folder_ / blocks_name);
    // First, so that a run whose folder is not yet gone when it is killed is not taken for one that has to go on.
    if (finished_ || !nothing) write(finished_ ? "finished" : "stopped");
    if (kept_ && (nothing || remove_)) remove_run_folder(folder_);
  }
  ::close(lock_);
}

void RunFolder::finished() {
  finished_ = true;
  remove_ = use_ == Use::file;
}

void RunFolder::finished_without_kept() {
  finished();
  remove_ = remove_ || !any_in(folder_ / blocks_name);
}

auto RunFolder::speed() const -> std::optional<double> {
  const std::size_t made = tally_.buildings_done - tally_.buildings_kept;
  if (!first_block_ || made == 0) return std::nullopt;
  const double seconds = std::chrono::duration<double>(Clock::now() - *first_block_).count();
  return seconds > 0 ? std::optional(static_cast<double>(made) / seconds) : std::nullopt;
}

void RunFolder::note(std::string_view stage, double fraction) {
  const auto now = Clock::now();
  const bool first = !first_block_ && tally_.blocks > 0;
  if (first) first_block_ = now;
  fraction_ = fraction;
  // Once a second, and whenever the stage changes; blocks go through theirs too quickly for that.
  if (!first && now - written_ < std::chrono::seconds(1) && (stage == stage_ || tally_.blocks > 0)) return;
  stage_ = stage;
  written_ = now;
  write("working");
}

void RunFolder::write(const std::string& state) {
  if (use_ == Use::share) return;  // several of them; what they have made shows in the folder
  Json out{{"verb", verb_},
           {"state", state},
           {"process", {{"id", ::getpid()}, {"host", base::host()}}},
           {"started", started_},
           {"began_empty", empty_},
           {"updated", base::utc_now()},
           {"seconds", std::round(std::chrono::duration<double>(Clock::now() - begin_).count() * 10) / 10},
           {"stage", stage_},
           {"fraction", std::round(fraction_ * 1e4) / 1e4},
           {"blocks", {{"all", +tally_.blocks}, {"done", +tally_.blocks_done}, {"taken_over", +tally_.blocks_kept}}},
           {"buildings",
            {{"all", +tally_.buildings}, {"done", +tally_.buildings_done}, {"taken_over", +tally_.buildings_kept}}}};
  const auto per_second = speed();
  out["buildings_per_second"] = per_second ? Json(std::round(*per_second * 100) / 100) : Json(nullptr);
  const auto left = static_cast<double>(tally_.buildings - tally_.buildings_done);
  out["seconds_left"] = per_second && state == "working" ? Json(std::round(left / *per_second)) : Json(nullptr);
  // Whoever looks must not stop the run: a status that cannot be written is an old one.
  (void)base::write_file(folder_ / status_name, out.dump(1) + "\n");
}

auto RunFolder::kept_in_words() const -> std::string {
  if (tally_.blocks_done == 0 || !any_in(folder_ / blocks_name)) return {};
  return std::to_string(tally_.blocks_done) + " of " + std::to_string(tally_.blocks) +
         " blocks are done and kept; the same command goes on from there";
}

void leave_run_folder() {
  const auto& folder = current();
  if (!folder.empty() && !any_in(folder / blocks_name)) remove_run_folder(folder);
}

auto began_empty(const fs::path& out) -> bool {
  const Json status = read_json(folder_of(out) / status_name);
  if (!status.is_object() || text_of(status, "state") == "finished") return false;
  const auto empty = status.find("began_empty");
  return empty != status.end() && empty->is_boolean() && empty->get<bool>();
}

auto status_json(const fs::path& out) -> base::Result<std::string> {
  const auto folder = folder_of(out);
  std::error_code status;
  if (!fs::exists(folder / status_name, status))
    return base::error("status-none",
                       "no run of mansard has worked there, or it kept nothing; give what 'mansard reconstruct' or "
                       "'mansard extrude' has as -o",
                       out.string());
  const auto text = base::read_file(folder / status_name);
  if (!text) return text.failure();
  Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || text_of(json, "state").empty())
    return base::error("file-read", "is not a status that mansard wrote; remove it", (folder / status_name).string());
  if (text_of(json, "state") == "working" && !locked(folder)) {
    json["state"] = "stopped";
    json["seconds_left"] = nullptr;
  }
  return json.dump(1) + "\n";
}

auto status_in_words(const std::string& text) -> std::string {
  const Json json = Json::parse(text);
  const std::string state = text_of(json, "state");
  const auto done = number_of(json, "blocks", "done"), all = number_of(json, "blocks", "all");
  const auto houses = number_of(json, "buildings", "done"), of_houses = number_of(json, "buildings", "all");
  const auto over = number_of(json, "blocks", "taken_over");
  std::string out = "mansard " + text_of(json, "verb") + ": " + state;
  out += state == "working"
             ? " since " + text_of(json, "started") + " (process " + std::to_string(number_of(json, "process", "id")) +
                   " on " + text_of(json["process"], "host") + ")\n"
             : " at " + text_of(json, "updated") + "\n";
  if (all == 0) {
    out += "stage: " + text_of(json, "stage") + "\n";
  } else {
    out += std::to_string(done) + " of " + std::to_string(all) + " blocks, " + std::to_string(houses) + " of " +
           std::to_string(of_houses) + " buildings";
    if (over > 0) out += " (" + std::to_string(over) + " blocks taken over from an earlier run)";
    out += "\n";
  }
  if (state == "working" && json["buildings_per_second"].is_number())
    out += base::to_text(json["buildings_per_second"].get<double>(), 2) + " buildings a second\n";
  if (json["seconds_left"].is_number())
    out += "about " + time_in_words(json["seconds_left"].get<double>()) + " left, then the files are written\n";
  if (state == "stopped" && done > 0) out += "the same command goes on from there\n";
  return out;
}

}  // namespace mansard::cli
