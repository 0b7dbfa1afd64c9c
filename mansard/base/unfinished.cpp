#include "mansard/base/unfinished.hpp"

#include <unistd.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/machine.hpp"
#include "mansard/base/text.hpp"

namespace mansard::base {
namespace {

namespace fs = std::filesystem;

auto mark(Beside what) -> std::string_view { return what == Beside::part ? ".part" : ".old"; }

/// What SQLite adds to the names of the files that it keeps beside a database while it writes.
constexpr std::array<std::string_view, 3> companions{"-journal", "-wal", "-shm"};

/// What a name says of who made it, and for which place.
struct Owner {
  std::string place;  ///< its file name
  Beside what = Beside::part;
  int process = 0;
  std::string host;
};

auto owner_of(std::string name) -> std::optional<Owner> {
  for (const auto companion : companions)
    if (name.ends_with(companion)) name.resize(name.size() - companion.size());
  for (const auto what : {Beside::part, Beside::old}) {
    const auto dot = name.rfind(mark(what));
    if (dot == name.npos || dot == 0) continue;
    const auto rest = std::string_view(name).substr(dot + mark(what).size());
    const auto at = rest.find('@');
    const auto number = to_integer(rest.substr(0, at));
    if (at == rest.npos || !number || *number <= 0 || *number > INT32_MAX) continue;
    return Owner{name.substr(0, dot), what, static_cast<int>(*number), std::string(rest.substr(at + 1))};
  }
  return std::nullopt;
}

auto may_be_running(const Owner& owner, const fs::path& path) -> bool {
  if (owner.host == host()) return owner.process == ::getpid() || ::kill(owner.process, 0) == 0 || errno != ESRCH;
  std::error_code failure;
  const auto changed = fs::last_write_time(path, failure);
  return !failure && fs::file_time_type::clock::now() - changed < std::chrono::hours(24);
}

struct Registry {
  std::recursive_mutex mutex;  // memory may run out while it is held
  std::set<fs::path> paths, swept;
  bool ending = false;
};

auto registry() -> Registry& {
  static auto* const one = new Registry;  // never destroyed: threads may outlive main
  return *one;
}

}  // namespace

auto beside(const fs::path& path, Beside what) -> fs::path {
  auto out = path;
  out += std::string(mark(what)) + std::to_string(::getpid()) + "@" + host();
  return out;
}

auto is_part(const fs::path& path) -> bool {
  const auto owner = owner_of(path.filename().string());
  return owner && owner->what == Beside::part;
}

void sweep(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> gone;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    const auto owner = owner_of(at->path().filename().string());
    if (!owner || may_be_running(*owner, at->path())) continue;
    std::error_code status;
    const fs::path place = folder / owner->place;
    if (owner->what == Beside::old && fs::symlink_status(place, status).type() == fs::file_type::not_found)
      fs::rename(at->path(), place, status);
    else gone.push_back(at->path());
  }
  for (const auto& path : gone) fs::remove_all(path, failure);
}

void sweep_beside(const fs::path& path) {
  const auto folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::error_code failure;
  const std::scoped_lock lock(registry().mutex);
  if (registry().swept.insert(fs::absolute(folder, failure)).second) sweep(folder);
}

void note_unfinished(const fs::path& path) {
  const std::scoped_lock lock(registry().mutex);
  registry().paths.insert(path);
}

void forget_unfinished(const fs::path& path) {
  const std::scoped_lock lock(registry().mutex);
  registry().paths.erase(path);
}

Finishing::Finishing() { registry().mutex.lock(); }
Finishing::~Finishing() { registry().mutex.unlock(); }

void remove_unfinished() {
  registry().mutex.lock();        // for good
  if (registry().ending) return;  // this thread itself, where it came to nothing in the loop below
  registry().ending = true;
  for (const auto& path : registry().paths) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
    for (const auto companion : companions) fs::remove(path.string() + std::string(companion), ignored);
  }
}

}  // namespace mansard::base
