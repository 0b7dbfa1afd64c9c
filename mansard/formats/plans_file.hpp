// A file of plans whose buildings are read on demand: only their places are in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats {

/// Every function but open() may be called from any thread. The file stays open: one that takes its place changes
/// nothing here.
class PlansFile {
 public:
  struct Place {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
    friend auto operator==(const Place&, const Place&) -> bool = default;
  };

  /// Null where the file cannot be read in this way: it is not a file of plans, its buildings do not come last, they
  /// are far from their origin, or something is wrong with it. Reading it as a whole tells which.
  [[nodiscard]] static auto open(const std::filesystem::path& path) -> std::unique_ptr<PlansFile>;
  /// The same, with the header that it had when it was opened before; nothing is read.
  [[nodiscard]] static auto open(const std::filesystem::path& path, Header header) -> std::unique_ptr<PlansFile>;
  ~PlansFile();
  PlansFile(const PlansFile&) = delete;
  auto operator=(const PlansFile&) -> PlansFile& = delete;

  [[nodiscard]] auto header() const -> const Header& { return header_; }

  /// Reads all buildings in one pass and calls take(number, place, building) with each, on all threads and in any
  /// order. False where something is wrong with the file.
  using Take = std::function<void(std::size_t, Place, model::Building&)>;
  [[nodiscard]] auto scan(const Take& take) const -> bool;

  /// Fails with "file-read", and as read_plans() where the file was changed.
  [[nodiscard]] auto read(const Place& place) const -> base::Result<model::Building>;
  /// Calls take(number, building) with those at the places, which must rise, on all threads and in any order. They have
  /// ids and attributes only, unless `all`.
  [[nodiscard]] auto read(const std::vector<Place>& places, bool all,
                          const std::function<void(std::size_t, model::Building&)>& take) const -> base::Result<void>;

 private:
  PlansFile(std::filesystem::path path, int file, Header header);
  [[nodiscard]] auto bytes_at(std::uint64_t offset, std::size_t count) const -> base::Result<std::string>;
  [[nodiscard]] auto building_of(std::string_view text, bool attributes_only) const -> base::Result<model::Building>;

  std::filesystem::path path_;
  int file_ = -1;
  Header header_;
};

}  // namespace mansard::formats
