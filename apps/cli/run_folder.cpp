#include "apps/cli/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
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

auto busy(const fs::path& out, const fs::path& folder) -> base::Diagnostic {
  const Json status = read_json(folder / status_name);
  std::string who = "another run of mansard works";
  if (status.is_object())
    who = "'mansard " + text_of(status, "verb") + "' works there since " + text_of(status, "started") + " (process " +
          std::to_string(number_of(status, "process", "id")) + " on " +
          (status.contains("process") ? text_of(status["process"], "host") : "") + ")";
  return base::error("output-busy", who + "; wait for its end, or choose another folder", out.string());
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
  const auto folder = out / run_folder_name;
  std::error_code failure;
  fs::create_directory(folder, failure);
  const auto unusable = [&](const std::string& why) {
    return base::error("file-write", "cannot write to this folder: " + why + "; choose a path with write permission",
                       folder.string());
  };
  if (failure) return unusable(failure.message());
  const int lock = ::open((folder / lock_name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock < 0) return unusable(std::strerror(errno));
  // The system takes the lock away with the process, however that ends. Where a file system has no locks, a run goes
  // without.
  if (::flock(lock, (use == Use::share ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(lock);
    return busy(out, folder);
  }
  std::unique_ptr<RunFolder> made(new RunFolder(folder, verb, use, lock, !holds_results(out) || began_empty(out)));
  if (use == Use::whole)
    for (const auto& entry : fs::directory_iterator(folder, failure))
      if (base::is_part(entry.path())) fs::remove(entry.path(), failure);
  auto kept = pipeline::KeptBlocks::open(folder / blocks_name, use == Use::whole);
  if (!kept) return kept.error();
  made->kept_ = std::move(*kept);
  made->write("working");
  return made;
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (use_ == Use::whole) {
    if (kept_ && !finished_ && fs::is_empty(folder_ / blocks_name, ignored)) fs::remove_all(folder_, ignored);
    else write(finished_ ? "finished" : "stopped");
  }
  ::close(lock_);
}

void RunFolder::finished() { finished_ = true; }

auto RunFolder::speed() const -> std::optional<double> {
  const std::size_t made = tally_.buildings_done - tally_.buildings_kept;
  if (!first_block_ || made == 0) return std::nullopt;
  const double seconds = std::chrono::duration<double>(Clock::now() - *first_block_).count();
  return seconds > 0 ? std::optional(static_cast<double>(made) / seconds) : std::nullopt;
}

void RunFolder::note(std::string_view stage, double fraction) {
  const auto now = Clock::now();
  if (!first_block_ && tally_.blocks > 0) first_block_ = now;
  fraction_ = fraction;
  if (now - written_ < std::chrono::seconds(1) && (stage == stage_ || tally_.blocks > 0)) return;
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
  if (tally_.blocks_done == 0) return {};
  return std::to_string(tally_.blocks_done) + " of " + std::to_string(tally_.blocks) +
         " blocks are done and kept; the same command goes on from there";
}

auto began_empty(const fs::path& out) -> bool {
  const Json status = read_json(out / run_folder_name / status_name);
  if (!status.is_object() || text_of(status, "state") == "finished") return false;
  const auto empty = status.find("began_empty");
  return empty != status.end() && empty->is_boolean() && empty->get<bool>();
}

auto status_json(const fs::path& out) -> base::Result<std::string> {
  const auto folder = out / run_folder_name;
  std::error_code status;
  if (!fs::exists(folder / status_name, status))
    return base::error("status-none",
                       "no run of mansard has worked in this folder, or it kept nothing; give the "
                       "folder that 'mansard reconstruct' has as -o",
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
