#include "apps/server/run_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "apps/server/json.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/pack.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/json_cursor.hpp"
#include "mansard/formats/json_list.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

/// Where the roof of a plan is at about half its height: what a box in place of the model has as its top.
auto middle_of_roof(const model::Plan& plan) -> double {
  double eaves = plan.cap, top = 0;
  for (const auto& profile : plan.profiles) {
    for (const auto& point : profile) top = std::max(top, point.height);
    const auto leaves = std::ranges::find_if(profile, [](const auto& point) { return point.inward > 0; });
    if (leaves != profile.begin() && leaves != profile.end()) eaves = std::min(eaves, std::prev(leaves)->height);
  }
  top = std::min(top > 0 ? top : plan.cap, plan.cap);
  return std::isfinite(top) ? (std::min(eaves, top) + top) / 2 : 0;
}

auto centimetres(double metres) -> std::string { return std::to_string(std::llround(100 * metres)); }

void append_shape(std::string& out, const model::Plan& plan) {
  (((out += '[') += centimetres(plan.base)) += ',') += centimetres(middle_of_roof(plan));
  for (const auto& p : plan.outer.points) (((out += ',') += centimetres(p.x)) += ',') += centimetres(p.y);
  out += ']';
}

/// The lists of names of attributes, each with the first place where it comes.
class NameLists {
 public:
  using At = std::pair<std::size_t, std::size_t>;  // building, part
  void add(const model::Attributes& attributes, At at) {
    const auto name_of = &model::Attributes::value_type::first;
    auto found = std::lower_bound(lists_.begin(), lists_.end(), attributes, [&](const auto& list, const auto& other) {
      return std::ranges::lexicographical_compare(list.first, other, {}, {}, name_of);
    });
    if (found == lists_.end() || !std::ranges::equal(found->first, attributes, {}, {}, name_of)) {
      std::vector<std::string> names;
      for (const auto& one : attributes) names.push_back(one.first);
      found = lists_.insert(found, {std::move(names), at});
    }
    found->second = std::min(found->second, at);
  }
  void append_new(std::vector<std::string>& names) const {
    auto ordered = lists_;
    std::ranges::sort(ordered, {}, &std::pair<std::vector<std::string>, At>::second);
    for (const auto& list : ordered)
      for (const auto& name : list.first)
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }

 private:
  std::vector<std::pair<std::vector<std::string>, At>> lists_;  // sorted by names
};

/// What is kept of a building while the file is read.
struct Scanned {
  std::string id;
  formats::PlansFile::Place place;
  geometry::Box2 box;
  std::optional<double> error;
  double ground = 0;
  bool marked = false;
  std::string shapes;
};

auto scanned(const fs::path& path, RunIndex& index) -> std::optional<std::vector<Scanned>> {
  const auto file = formats::PlansFile::open(path);
  if (file == nullptr) return std::nullopt;
  index.header = file->header();
  std::mutex mutex;
  std::vector<Scanned> all;
  NameLists of_buildings, of_parts;
  const bool read = file->scan([&](std::size_t number, formats::PlansFile::Place place, model::Building& building) {
    Scanned one{std::move(building.id), place, {}, error_of(building), building.ground, has_mark(building), "["};
    for (const auto& part : building.parts) {
      one.box.include(geometry::Box2::of(part.plan.outer.points));
      if (one.shapes.size() > 1) one.shapes += ',';
      append_shape(one.shapes, part.plan);
    }
    one.shapes += ']';
    const std::scoped_lock lock(mutex);
    of_buildings.add(building.attributes, {number, 0});
    for (std::size_t p = 0; p < building.parts.size(); ++p) of_parts.add(building.parts[p].attributes, {number, p});
    if (all.size() <= number) all.resize(number + 1);
    all[number] = std::move(one);
  });
  if (!read) return std::nullopt;
  of_buildings.append_new(index.attributes);
  of_parts.append_new(index.attributes);
  return all;
}

/// What is needed of one of the "buildings" of a report.json.
struct ReportRow {
  std::string id, block, outcome, reasons;
  std::optional<double> ground, volume, confidence;
};

/// A building of a report; false where something is unusual.
auto row_of(std::string_view text, ReportRow& row) -> bool {
  formats::JsonCursor json(text);
  int found = 0;  // those that must be there
  json.object([&](std::string_view name) {
    const auto take = [&](std::string& to) {
      to = json.text();
      ++found;
    };
    if (name == "id") take(row.id);
    else if (name == "block") take(row.block);
    else if (name == "outcome") take(row.outcome);
    else if (name == "ground_m") row.ground = json.number();
    else if (name == "volume_m3") row.volume = json.number();
    else if (name == "reasons") {
      const auto reasons = json.skip();
      ++found;
      if (!json.good() || reasons.front() != '[') return json.fail();
      const auto parsed = Json::parse(reasons, nullptr, false);
      row.reasons = parsed.empty() ? std::string() : text_of(parsed);
    } else if (name == "confidence") {
      json.object([&](std::string_view of) {
        if (of == "right") row.confidence = json.number();
        else json.skip();
      });
      if (!row.confidence) json.fail();
    } else json.skip();
  });
  return json.done() && found == 4 && !row.outcome.empty();
}

auto rows_of(const fs::path& path) -> std::optional<std::vector<ReportRow>> {
  const auto list = formats::JsonList::open(path, "buildings");
  if (list == nullptr) return std::nullopt;
  std::mutex mutex;
  std::vector<ReportRow> all;
  const bool read = list->each([&](const std::vector<formats::JsonList::Item>& items) {
    std::vector<ReportRow> rows(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
      if (!row_of(items[i].text, rows[i])) return false;
    const std::scoped_lock lock(mutex);
    const auto end = items.back().number + 1;
    if (all.size() < end) all.resize(end);
    std::ranges::move(rows, all.begin() + static_cast<std::ptrdiff_t>(items.front().number));
    return true;
  });
  if (!read) return std::nullopt;
  // The rest of the report is checked, and not kept.
  const auto text = list->head() + list->tail();
  formats::JsonCursor rest(text);
  rest.skip();
  return rest.done() ? std::optional(std::move(all)) : std::nullopt;
}

// ---- the file

/// Changed with what a RunIndex has, how it is computed, or how it is written.
constexpr std::string_view index_format = "mansard run index 1 ";
constexpr const char* index_file = "index.bin";
constexpr std::size_t hashed = std::size_t{1} << 16U;  // bytes at each end of a file

/// What tells one version of a file from another.
struct Version {
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;
  std::string ends;  ///< SHA-256 of the first and the last bytes
  friend auto operator==(const Version&, const Version&) -> bool = default;
};

auto version_of(const fs::path& path) -> std::optional<Version> {
  const auto stamp = stamp_of(path);
  if (!stamp) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string ends(2 * hashed, '\0');
  file.read(ends.data(), static_cast<std::streamsize>(hashed));
  auto size = static_cast<std::size_t>(file.gcount());
  if (stamp->bytes > hashed) {
    file.clear();
    file.seekg(static_cast<std::streamoff>(stamp->bytes - std::min<std::uint64_t>(hashed, stamp->bytes - hashed)));
    file.read(ends.data() + size, static_cast<std::streamsize>(hashed));
    size += static_cast<std::size_t>(file.gcount());
  }
  if (file.bad()) return std::nullopt;
  ends.resize(size);
  return Version{stamp->bytes, stamp->modified, formats::sha256(ends)};
}

/// Finds damage, not intent.
auto checksum(std::string_view bytes) -> std::uint64_t {
  std::uint64_t sum = bytes.size();
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const auto count = std::min(bytes.size(), sizeof(word));
    std::memcpy(&word, bytes.data(), count);
    bytes.remove_prefix(count);
    sum = (std::rotl(sum, 5) ^ word) * 0x9e3779b97f4a7c15ULL;
  }
  return sum;
}

/// What the index of a folder must start with; none where a file is missing.
auto start_of(const fs::path& folder) -> std::optional<std::string> {
  std::string out(index_format);
  out += MANSARD_VERSION;
  for (const auto* name : {"plans.json", "report.json"}) {
    const auto version = version_of(folder / name);
    if (!version) return std::nullopt;
    base::pack(*version, out);
  }
  return out;
}

/// Whether the parts of an index that was read fit together.
auto is_complete(const RunIndex& index) -> bool {
  const auto count = index.ids.size();
  const auto same = [&](const auto&... columns) { return ((columns.size() == count) && ...); };
  const auto in_strings = [&](const auto& column) {
    return std::ranges::all_of(column, [&](auto at) { return at < index.strings.size(); });
  };
  return same(index.places, index.boxes, index.errors, index.marked, index.shape_ends, index.blocks, index.outcomes,
              index.reasons, index.grounds, index.volumes, index.confidences) &&
         in_strings(index.blocks) && in_strings(index.outcomes) && in_strings(index.reasons) &&
         std::ranges::is_sorted(index.shape_ends) &&
         (count == 0 ? index.shapes.empty() : index.shape_ends.back() == index.shapes.size());
}

auto made(const fs::path& folder) -> std::optional<RunIndex> {
  RunIndex index;
  auto buildings = scanned(folder / "plans.json", index);
  if (!buildings) return std::nullopt;
  const auto count = buildings->size();
  std::unordered_map<std::string_view, std::size_t> at;
  at.reserve(count);
  for (std::size_t b = 0; b < count; ++b)
    if (!at.emplace((*buildings)[b].id, b).second) return std::nullopt;  // two of one id

  std::unordered_map<std::string, std::uint32_t> known;
  const auto number_of_text = [&](std::string& text) {
    const auto [found, is_new] = known.emplace(std::move(text), static_cast<std::uint32_t>(index.strings.size()));
    if (is_new) index.strings.push_back(found->first);
    return found->second;
  };
  {
    auto rows = rows_of(folder / "report.json");
    if (!rows) return std::nullopt;
    const auto z0 = static_cast<double>(index.header.frame.origin[2]);
    index.blocks.resize(count);
    index.outcomes.resize(count);
    index.reasons.resize(count);
    index.grounds.resize(count);
    index.volumes.resize(count);
    index.confidences.resize(count);
    std::vector<char> seen(count);
    for (auto& row : *rows) {
      const auto found = at.find(row.id);
      if (found == at.end()) continue;
      const auto b = found->second;
      if (seen[b]++ != 0) return std::nullopt;
      index.blocks[b] = number_of_text(row.block);
      index.outcomes[b] = number_of_text(row.outcome);
      index.reasons[b] = number_of_text(row.reasons);
      // The report has no ground height for a building without parts; the plans have it.
      index.grounds[b] = row.ground ? *row.ground - z0 : (*buildings)[b].ground;
      index.volumes[b] = row.volume.value_or(0);
      index.confidences[b] = row.confidence;
    }
    if (std::ranges::find(seen, 0) != seen.end()) return std::nullopt;
  }
  std::size_t length = 0;
  for (const auto& one : *buildings) length += one.shapes.size();
  index.shapes.reserve(length);
  for (auto& one : *buildings) {
    index.ids.push_back(std::move(one.id));
    index.places.push_back(one.place);
    index.boxes.push_back(one.box);
    index.errors.push_back(one.error);
    index.marked.push_back(one.marked ? 1 : 0);
    index.shapes += one.shapes;
    index.shape_ends.push_back(index.shapes.size());
    one.shapes = {};
  }
  return index;
}

auto kept(const fs::path& path, const std::string& start) -> std::optional<RunIndex> {
  const auto bytes = base::read_file(path);
  if (!bytes) return std::nullopt;
  std::string_view rest(*bytes);
  std::uint64_t sum = 0;
  if (rest.size() < start.size() + sizeof(sum) || !rest.starts_with(start)) return std::nullopt;
  rest.remove_prefix(start.size());
  std::memcpy(&sum, rest.data(), sizeof(sum));
  rest.remove_prefix(sizeof(sum));
  if (checksum(rest) != sum) return std::nullopt;
  RunIndex index;
  base::Unpacker from(rest);
  if (!from.take(index) || !from.done() || !is_complete(index)) return std::nullopt;
  return index;
}

void keep(const fs::path& path, std::string bytes, const RunIndex& index) {
  const auto at = bytes.size();
  bytes.append(sizeof(std::uint64_t), '\0');
  base::pack(index, bytes);
  const auto sum = checksum(std::string_view(bytes).substr(at + sizeof(std::uint64_t)));
  std::memcpy(bytes.data() + at, &sum, sizeof(sum));
  (void)base::write_file(path, bytes);
}

}  // namespace

auto shapes_of(const std::vector<edit::NamedPlan>& parts) -> std::string {
  std::string out = "[";
  for (const auto& part : parts) {
    if (out.size() > 1) out += ',';
    append_shape(out, part.plan);
  }
  return out + ']';
}

auto number_of(const model::Attributes& attributes, std::string_view name) -> std::optional<double> {
  for (const auto& [key, value] : attributes)
    if (const auto* found = std::get_if<double>(&value); found != nullptr && key == name) return *found;
  return std::nullopt;
}

auto error_of(const model::Building& building) -> std::optional<double> {
  double sum = 0, area = 0;
  for (const auto& part : building.parts) {
    const auto rmse = number_of(part.attributes, "ms_rmse_lod22");
    const double own = geometry::area(model::polygon_of(part.plan));
    if (rmse) sum += *rmse * *rmse * own, area += own;
  }
  return area > 0 ? std::optional(sum / area) : std::nullopt;
}

auto has_mark(const model::Building& building) -> bool {
  const auto marked = [](const model::Attributes& attributes) {
    return std::ranges::any_of(attributes, [](const auto& one) {
      const auto* flag = std::get_if<bool>(&one.second);
      return one.first == edit::edited_mark && (flag == nullptr || *flag);
    });
  };
  return marked(building.attributes) ||
         std::ranges::any_of(building.parts, [&](const auto& part) { return marked(part.attributes); });
}

auto run_index(const fs::path& folder) -> std::optional<RunIndex> {
  const auto path = folder / index_file;
  auto start = start_of(folder);  // before the files are read: what changes meanwhile does not fit the index
  if (!start) return std::nullopt;
  if (auto index = kept(path, *start)) return index;
  auto index = made(folder);
  if (index) keep(path, std::move(*start), *index);
  return index;
}

}  // namespace mansard::server
