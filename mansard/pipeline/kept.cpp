#include "mansard/pipeline/kept.hpp"

#include <set>

#include "mansard/base/files.hpp"
#include "mansard/base/pack.hpp"
#include "mansard/base/unfinished.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/pipeline/detail/assemble.hpp"

namespace mansard::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr auto list_name = "last";
constexpr std::size_t digits = 64;  // of a SHA-256

/// The bytes after their own hash: a file that is cut off or damaged does not pass for a whole one.
auto sealed(std::string_view bytes) -> std::string { return formats::sha256(bytes) + std::string(bytes); }
auto unsealed(const fs::path& path) -> std::optional<std::string> {
  auto whole = base::read_file(path);
  if (!whole || whole->size() < digits) return std::nullopt;
  const std::string seal = whole->substr(0, digits);
  whole->erase(0, digits);
  if (formats::sha256(*whole) != seal) return std::nullopt;
  return std::move(*whole);
}

auto files_in(const fs::path& folder) -> std::vector<fs::path> {
  std::vector<fs::path> files;
  std::error_code failure;
  for (auto entry = fs::recursive_directory_iterator(folder, failure);
       !failure && entry != fs::recursive_directory_iterator(); entry.increment(failure)) {
    std::error_code status;
    if (entry->is_regular_file(status)) files.push_back(entry->path());
  }
  return files;
}

}  // namespace

auto BlockKey::hash() const -> std::string { return formats::sha256(program + options + footprints + mesh); }

auto program_hash() -> const std::string& {
  static const std::string hash = [] {
    const auto file = base::read_file("/proc/self/exe");
    return formats::sha256(detail::version() + (file ? formats::sha256(*file) : std::string()));
  }();
  return hash;
}

auto KeptBlocks::open(const fs::path& folder, bool alone) -> base::Result<std::unique_ptr<KeptBlocks>> {
  std::unique_ptr<KeptBlocks> out(new KeptBlocks(folder));
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    return base::error("file-write",
                       "cannot make this folder: " + failure.message() + "; choose a place with write permission",
                       folder.string());
  if (alone)
    for (const auto& path : files_in(folder))
      if (base::is_part(path)) fs::remove(path, failure);
  if (const auto list = unsealed(folder / list_name)) {
    std::vector<std::pair<std::string, BlockKey>> last;
    if (base::Unpacker(*list).take(last)) out->last_ = {last.begin(), last.end()};
  }
  return out;
}

auto KeptBlocks::path_of(const BlockKey& key) const -> fs::path {
  const std::string hash = key.hash();
  return folder_ / hash.substr(0, 2) / hash.substr(2);  // no folder with a hundred thousand files
}

auto KeptBlocks::find(const BlockKey& key) const -> std::optional<std::string> { return unsealed(path_of(key)); }

auto KeptBlocks::keep(const BlockKey& key, std::string_view bytes) -> base::Result<void> {
  const auto path = path_of(key);
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);  // write_file says what is wrong
  return base::write_file(path, sealed(bytes));
}

auto KeptBlocks::why_made(const std::string& name, const BlockKey& key) const -> std::string {
  if (last_.empty()) return {};
  const auto before = last_.find(name);
  if (before == last_.end()) return "new";
  if (before->second.program != key.program) return "program";
  if (before->second.options != key.options) return "options";
  if (before->second.footprints != key.footprints) return "footprints";
  if (before->second.mesh != key.mesh) return "mesh";
  return "damaged";
}

auto KeptBlocks::settle(const std::map<std::string, BlockKey>& blocks) -> base::Result<void> {
  std::set<fs::path> wanted{folder_ / list_name};
  for (const auto& [name, key] : blocks) wanted.insert(path_of(key));
  const std::vector<std::pair<std::string, BlockKey>> list(blocks.begin(), blocks.end());
  if (auto written = base::write_file(folder_ / list_name, sealed(base::packed(list))); !written) return written;
  last_ = blocks;
  std::error_code ignored;
  for (const auto& path : files_in(folder_))
    if (!wanted.contains(path)) fs::remove(path, ignored);
  return {};
}

}  // namespace mansard::pipeline
