// What a run keeps beside its results, in OUTDIR/.mansard, or in FILE.mansard where the output is a file: a lock, how
// far it is, and the blocks that are done, for the same command to go on from.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/pipeline/kept.hpp"

namespace mansard::cli {

/// The name of that folder in OUTDIR, and what is added to the name of an output file.
inline constexpr auto run_folder_name = ".mansard";

/// One process works in a folder at a time; several where all of them make shares of one run.
class RunFolder {
 public:
  enum class Use {
    whole,  ///< of a folder, where what was kept stays for later runs
    share,  ///< of a folder
    file,   ///< whose folder goes when the run has finished
  };

  /// Locks `out`, which must be there unless it is a file, and writes down who works in it. Fails with "output-busy"
  /// (who, since when), "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& out, const std::string& verb, Use use)
      -> base::Result<std::unique_ptr<RunFolder>>;
  RunFolder(const RunFolder&) = delete;
  auto operator=(const RunFolder&) -> RunFolder& = delete;
  /// Unlocks; where no block is kept, nothing of it stays. A run that did not end with `finished` is "stopped".
  ~RunFolder();

  /// What is shown of the run so far, and how far it is by the tally; written at most once a second, or where `stage`
  /// is another one.
  void note(std::string_view stage, double fraction);
  void finished();
  /// The same of a run that keeps nothing: where no earlier one did, nothing stays.
  void finished_without_kept();

  [[nodiscard]] auto kept() -> pipeline::KeptBlocks* { return kept_.get(); }
  [[nodiscard]] auto tally() -> pipeline::Tally& { return tally_; }
  /// "12 of 20 blocks are done and kept: the same command goes on from there"; empty where none is.
  [[nodiscard]] auto kept_in_words() const -> std::string;

 private:
  RunFolder(std::filesystem::path folder, std::string verb, Use use, int lock, bool empty);
  void write(const std::string& state);
  [[nodiscard]] auto speed() const -> std::optional<double>;

  std::filesystem::path folder_;
  std::string verb_;
  Use use_;
  int lock_ = -1;
  std::unique_ptr<pipeline::KeptBlocks> kept_;
  pipeline::Tally tally_;
  std::string stage_, started_;
  double fraction_ = 0;
  bool finished_ = false, empty_ = false, remove_ = false;
  std::chrono::steady_clock::time_point begin_, written_;
  std::optional<std::chrono::steady_clock::time_point> first_block_;  ///< from when on blocks were worked on
};

/// For a process that ends without its destructors, after base::remove_unfinished: what ~RunFolder would take away.
void leave_run_folder();

/// Whether the last run in a folder, or to a file, found no results there and did not come to its end: what is there
/// now is its own, and the same command may replace it.
[[nodiscard]] auto began_empty(const std::filesystem::path& out) -> bool;

/// What is known of the run in a folder, or to a file: its status.json with "state" brought up to date – "working",
/// "finished", or "stopped", also where it was killed. Fails with "status-none", "file-read".
[[nodiscard]] auto status_json(const std::filesystem::path& out) -> base::Result<std::string>;
/// The same in a few lines for people.
[[nodiscard]] auto status_in_words(const std::string& json) -> std::string;

}  // namespace mansard::cli
