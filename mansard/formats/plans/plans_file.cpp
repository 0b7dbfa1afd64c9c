#include "mansard/formats/plans_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "mansard/base/run.hpp"
#include "mansard/formats/json_list.hpp"
#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/formats/plans/quick_building.hpp"

namespace mansard::formats {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20U;  // bytes that are read at once

auto is_near(const model::Building& building) -> bool {
  return std::ranges::all_of(building.parts, [](const auto& part) {
    return std::ranges::all_of(part.plan.outer.points, [](const auto p) {
      return std::max(std::abs(p.x), std::abs(p.y)) <= detail::near_origin;
    });
  });
}

auto is_end(std::string_view tail) -> bool {
  std::string left;
  for (const char c : tail)
    if (c != ' ' && c != '\n' && c != '\r' && c != '\t') left += c;
  return left == "]}";
}

}  // namespace

PlansFile::PlansFile(std::filesystem::path path, int file, Header header)
    : path_(std::move(path)), file_(file), header_(std::move(header)) {}

PlansFile::~PlansFile() { ::close(file_); }

auto PlansFile::open(const std::filesystem::path& path, Header header) -> std::unique_ptr<PlansFile> {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return nullptr;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return nullptr;
  return std::unique_ptr<PlansFile>(new PlansFile(path, file, std::move(header)));
}

auto PlansFile::open(const std::filesystem::path& path) -> std::unique_ptr<PlansFile> {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return nullptr;
  const auto list = JsonList::open(path, "buildings");
  if (list == nullptr) return nullptr;
  try {
    const auto json = detail::parse_json(list->head() + "]}");
    return open(path, detail::read_header(detail::Item{json, {}}, {"buildings"}));
  } catch (const detail::Defect&) {
    return nullptr;
  }
}

auto PlansFile::scan(const Take& take) const -> bool {
  const auto list = JsonList::open("/proc/self/fd/" + std::to_string(file_), "buildings");
  if (list == nullptr) return false;
  std::atomic<bool> any = false;
  const bool read = list->each([&](const std::vector<JsonList::Item>& items) {
    any = true;
    for (const auto& item : items) {
      model::Building building;
      if (item.text.size() > UINT32_MAX || !detail::quick_building(item.text, building)) {
        auto slow = building_of(item.text, false);
        if (!slow) return false;
        building = std::move(*slow);
      }
      if (item.number == 0 && !is_near(building)) return false;
      take(item.number, {item.offset, static_cast<std::uint32_t>(item.text.size())}, building);
    }
    return true;
  });
  return read && any && is_end(list->tail());
}

auto PlansFile::bytes_at(std::uint64_t offset, std::size_t count) const -> base::Result<std::string> {
  std::string bytes(count, '\0');
  for (std::size_t done = 0; done < count;) {
    const auto got = ::pread(file_, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      return base::error("file-read",
                         got < 0 ? std::system_category().message(errno) : std::string("the file became shorter"),
                         path_.string());
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

auto PlansFile::building_of(std::string_view text, bool attributes_only) const -> base::Result<model::Building> {
  model::Building building;
  if (detail::quick_building(text, building, attributes_only)) return building;
  try {
    const auto json = detail::parse_json(text);
    return detail::read_building(detail::Item{json, {}});
  } catch (const detail::Defect& defect) {
    return base::error(defect.code, defect.message, path_.string());
  }
}

auto PlansFile::read(const Place& place) const -> base::Result<model::Building> {
  const auto bytes = bytes_at(place.offset, place.bytes);
  return bytes ? building_of(*bytes, false) : base::Result<model::Building>(bytes.failure());
}

auto PlansFile::read(const std::vector<Place>& places, bool all,
                     const std::function<void(std::size_t, model::Building&)>& take) const -> base::Result<void> {
  struct Piece {
    std::size_t first = 0, last = 0;
  };
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (pieces.empty() || places[i].offset + places[i].bytes - places[pieces.back().first].offset > piece)
      pieces.push_back({i, i});
    pieces.back().last = i;
  }
  std::mutex mutex;
  std::optional<base::Failure> failure;
  std::atomic<bool> failed = false;
  const auto fail = [&](base::Failure why) {
    const std::scoped_lock lock(mutex);
    if (!failure) failure = std::move(why);
    failed = true;
  };
  base::parallel_for(pieces.size(), [&](std::size_t p) {
    if (failed) return;
    const auto [first, last] = pieces[p];
    const auto from = places[first].offset;
    const auto bytes = bytes_at(from, places[last].offset + places[last].bytes - from);
    if (!bytes) return fail(bytes.failure());
    for (std::size_t i = first; i <= last; ++i) {
      auto building = building_of(std::string_view(*bytes).substr(places[i].offset - from, places[i].bytes), !all);
      if (!building) return fail(building.failure());
      take(i, *building);
    }
  });
  if (failure) return *failure;
  return {};
}

}  // namespace mansard::formats
