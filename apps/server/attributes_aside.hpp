// Attributes of the buildings of a large run, put aside on disk: they would take more memory than all else of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"

namespace mansard::server {

/// In a file without a name in the folder for temporary files (TMPDIR); names of attributes are kept once.
class AttributesAside {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open() -> base::Result<std::unique_ptr<AttributesAside>>;

  /// Takes the attributes off a building and its parts. Buildings are numbered by the calls, from 0.
  void add(model::Building& building);
  /// Puts them back, into a building with the same parts. From any thread. Fails with "file-write" where what was put
  /// aside cannot be read.
  [[nodiscard]] auto restore(std::size_t number, model::Building& building) const -> base::Result<void>;

  /// In the order in which they came: of buildings, then of parts.
  [[nodiscard]] auto names() const -> std::vector<std::string>;

 private:
  using Names = std::vector<std::string>;
  struct Place {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
  };
  struct Lists {
    std::vector<Names> all;
    std::map<Names, std::uint32_t> numbers;
    auto number_of(const model::Attributes& attributes) -> std::uint32_t;
  };
  std::unique_ptr<base::Spool> spool_;
  mutable std::mutex mutex_;  ///< guards the file
  std::vector<Place> places_;
  Lists of_buildings_, of_parts_;
};

}  // namespace mansard::server
