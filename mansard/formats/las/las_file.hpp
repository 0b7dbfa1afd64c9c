// One LAS or LAZ file: plain records, chunks by their table, or the nodes of a COPC octree.
#pragma once

#include <filesystem>
#include <memory>

#include "mansard/formats/files/ranges.hpp"
#include "mansard/formats/las/las_header.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::formats {

class LasFile : public PointCloud {
 public:
  /// Fails as open_points does.
  [[nodiscard]] static auto open(const std::filesystem::path& path) -> base::Result<std::unique_ptr<LasFile>>;

  [[nodiscard]] auto header() const -> const LasHeader& { return header_; }
  /// The records of a piece, as uncompressed LAS has them; those of LAZ without wave packets. Fails as `read` does.
  [[nodiscard]] auto records(std::size_t piece) const -> base::Result<std::string>;

  [[nodiscard]] auto info() const -> const PointInfo& override { return info_; }
  [[nodiscard]] auto pieces() const -> std::size_t override { return pieces_.size(); }
  [[nodiscard]] auto points_of(std::size_t piece) const -> std::uint64_t override { return pieces_[piece].points; }
  [[nodiscard]] auto box_of(std::size_t piece) const -> std::optional<geometry::Box3> override {
    return pieces_[piece].box;
  }
  [[nodiscard]] auto read(std::size_t piece) const -> base::Result<std::vector<CloudPoint>> override;
  [[nodiscard]] auto inputs() const -> base::Result<std::vector<model::InputFile>> override;

 private:
  struct Piece {
    std::uint64_t offset = 0, bytes = 0, points = 0;
    std::optional<geometry::Box3> box;
  };
  [[nodiscard]] auto find_pieces() -> base::Result<void>;
  [[nodiscard]] auto plain_pieces() -> base::Result<void>;
  [[nodiscard]] auto check_items(const LasRecord& record) const -> base::Result<void>;
  [[nodiscard]] auto chunks(std::uint32_t chunk_size) -> base::Result<void>;
  [[nodiscard]] auto nodes() -> bool;
  [[nodiscard]] auto decoded(std::string_view chunk, std::uint64_t points) const -> base::Result<std::string>;
  /// Of what records() gives.
  [[nodiscard]] auto bytes_of_record() const -> std::size_t;
  void describe();

  std::filesystem::path path_;
  std::string name_;
  std::shared_ptr<const RangeFile> file_;
  LasHeader header_;
  std::vector<Piece> pieces_;
  bool is_copc_ = false;
  PointInfo info_;
};

}  // namespace mansard::formats
