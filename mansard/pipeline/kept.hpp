// Blocks that were made before, kept in a folder: a run goes on where an earlier one stopped, and makes again only what
// has changed. A block is a function of its own footprints, its piece of the mesh, the options and the program; what is
// kept is found by the hash of all of these, so that nothing else can be taken for it (docs/decisions/0046-kept.md).
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::pipeline {

/// What a block is made of, each as its SHA-256; two blocks with the same are the same.
struct BlockKey {
  std::string program;     ///< version and file of the running program
  std::string options;     ///< all that are not of reading or writing, and what is kept beside the models
  std::string footprints;  ///< name, members and outline, in the block's own frame
  std::string mesh;        ///< its piece of the mesh, and its ground
  friend auto operator==(const BlockKey&, const BlockKey&) -> bool = default;
  [[nodiscard]] auto hash() const -> std::string;
};

class KeptBlocks {
 public:
  /// `folder` is made where it is missing. With `alone`, which is only true where no other process works in the folder,
  /// what a killed one left half-written is taken away. Fails with "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& folder, bool alone = true)
      -> base::Result<std::unique_ptr<KeptBlocks>>;

  /// What was kept by that key; none where there is nothing, or where the file is not as it was written.
  [[nodiscard]] auto find(const BlockKey& key) const -> std::optional<std::string>;
  /// Keeps it from now on, also over the end of the process. Fails with "file-write". From any thread.
  [[nodiscard]] auto keep(const BlockKey& key, std::string_view bytes) -> base::Result<void>;

  /// Why a block of that name is made although blocks are kept: "program", "options", "footprints", "mesh", or "new"
  /// where the last whole run had none of the name. Empty where there was no whole run.
  [[nodiscard]] auto why_made(const std::string& name, const BlockKey& key) const -> std::string;

  /// After a whole run of these blocks: what belongs to no block of it is taken away. Fails with "file-write".
  [[nodiscard]] auto settle(const std::map<std::string, BlockKey>& blocks) -> base::Result<void>;

 private:
  explicit KeptBlocks(std::filesystem::path folder) : folder_(std::move(folder)) {}
  [[nodiscard]] auto path_of(const BlockKey& key) const -> std::filesystem::path;

  std::filesystem::path folder_;
  std::map<std::string, BlockKey> last_;  ///< by block name, of the last whole run
};

/// How far a run is; written by the threads that work, read by whoever shows it.
struct Tally {
  std::atomic<std::size_t> blocks{0}, blocks_done{0}, blocks_kept{0};  ///< kept: of those done, taken from KeptBlocks
  std::atomic<std::size_t> buildings{0}, buildings_done{0}, buildings_kept{0};
};

/// How the work of a run is shared, remembered and watched. It changes nothing in what comes out.
struct Schedule {
  KeptBlocks* kept = nullptr;
  Tally* tally = nullptr;
};

/// The hash of the program that runs: its version and the bytes of its file.
[[nodiscard]] auto program_hash() -> const std::string&;

}  // namespace mansard::pipeline
