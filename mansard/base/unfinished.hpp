// Files and folders on their way to their places: their names, and what becomes of them when a run ends before its
// time.
#pragma once

#include <filesystem>

namespace mansard::base {

/// Beside `path`, under a name that says which process of which machine made it: "….part4711@host" while it is made,
/// "….old4711@host" for what it replaces until all results of the run are in their places.
enum class Beside { part, old };
[[nodiscard]] auto beside(const std::filesystem::path& path, Beside what) -> std::filesystem::path;

/// Whether a file or folder is on its way to its place, or is a file of a database on its way.
[[nodiscard]] auto is_part(const std::filesystem::path& path) -> bool;

/// Removes such files and folders in `folder` whose process ended before its time, by kill or by a power cut. What such
/// a process was about to replace is put back where nothing took its place. Left alone is what a running process owns,
/// and on file systems of several machines what another machine's process may own: what was changed there in the last
/// day.
void sweep(const std::filesystem::path& folder);
/// The same for the folder of `path`, if this process did not do it before.
void sweep_beside(const std::filesystem::path& path);

/// For what is at `path` from now on, remove_unfinished() is responsible, until it is forgotten.
void note_unfinished(const std::filesystem::path& path);
void forget_unfinished(const std::filesystem::path& path);

/// While one lives, a call of `remove_unfinished` in another thread waits: the results of a run take their places
/// together.
class Finishing {
 public:
  Finishing();
  Finishing(const Finishing&) = delete;
  auto operator=(const Finishing&) -> Finishing& = delete;
  ~Finishing();
};

/// For a process that has to end at once, without its destructors: removes everything that is unfinished. From then on
/// no other thread begins or finishes a file. The caller ends the process; calls from other threads do not return.
void remove_unfinished();

}  // namespace mansard::base
