// One mesh file of any size, piece by piece.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/running_hash.hpp"
#include "mansard/formats/up_axis.hpp"

namespace mansard::formats {

/// Takes what comes next in a file: vertices, and triangles. Their indices count the vertices of the whole file from 0;
/// a triangle can name vertices that come later, or that do not exist.
using TakePiece = std::function<void(RawMesh piece)>;

/// A file on disk that is read once from its start to its end, of which some bytes are in memory. Not a memory map,
/// which would take the address space of the whole file.
class FileWindow {
 public:
  static constexpr std::size_t usual = std::size_t{1} << 24;  ///< bytes: some pieces for each of several threads

  /// None where it is not a file on disk, or empty, or cannot be opened.
  [[nodiscard]] static auto open(const std::filesystem::path& path) -> std::optional<FileWindow>;
  FileWindow(FileWindow&& other) noexcept;
  FileWindow(const FileWindow&) = delete;
  auto operator=(const FileWindow&) -> FileWindow& = delete;
  auto operator=(FileWindow&&) -> FileWindow& = delete;
  ~FileWindow();

  /// Reads until at least `count` bytes are in memory, or all that the file has left. Fails with "file-read".
  [[nodiscard]] auto fill(std::size_t count) -> base::Result<void>;
  /// The bytes in memory, from where the file was advanced to.
  [[nodiscard]] auto view() const -> std::string_view { return std::string_view(bytes_).substr(start_); }
  void advance(std::size_t count) { start_ += count; }
  /// Whether the bytes in memory are the last ones.
  [[nodiscard]] auto at_end() const -> bool { return at_end_; }
  /// Of the whole file.
  [[nodiscard]] auto size() const -> std::uint64_t { return size_; }
  /// Bytes from where the file was advanced to, up to its end.
  [[nodiscard]] auto left() const -> std::uint64_t { return std::max(size_, read_) - read_ + view().size(); }
  /// Of the whole file; reads on to its end. Fails with "file-read". Can be called once.
  [[nodiscard]] auto sha256() -> base::Result<std::string>;

 private:
  FileWindow(int file, std::uint64_t size, std::string name) : file_(file), size_(size), name_(std::move(name)) {}
  int file_;
  std::uint64_t size_, read_ = 0;
  std::string name_, bytes_;
  std::size_t start_ = 0;
  bool at_end_ = false;
  Sha256 hash_;
};

/// As read_obj; cancelled, it stops early.
[[nodiscard]] auto stream_obj(FileWindow& file, const std::string& name, const TakePiece& take, const base::Run& run)
    -> base::Result<void>;
/// As read_ply, without classes; cancelled, it stops early. False where the file is not a binary PLY with vertices:
/// nothing was taken then.
[[nodiscard]] auto stream_ply(FileWindow& file, const std::string& name, const TakePiece& take, const base::Run& run)
    -> base::Result<bool>;

/// "ingest-memory": more vertices than indices of 32 bits have numbers for.
[[nodiscard]] auto too_many_vertices(const std::string& name) -> base::Diagnostic;

/// As read_mesh_file, in memory that does not grow with the file: OBJ and binary PLY on disk. The result has no mesh,
/// and the pieces have no classes. None for other files, of which nothing was taken.
[[nodiscard]] auto stream_mesh_file(const std::filesystem::path& path, UpAxis up, const TakePiece& take,
                                    const base::Run& run) -> std::optional<MeshPiece>;

}  // namespace mansard::formats
