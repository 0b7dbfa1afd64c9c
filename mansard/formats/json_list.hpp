// A JSON file with a long list at its top: the text of each item, in pieces, on all threads. The file is never in
// memory as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mansard::formats {

class JsonList {
 public:
  struct Item {
    std::size_t number = 0;    ///< in the list, from 0
    std::uint64_t offset = 0;  ///< of its first byte in the file
    std::string_view text;     ///< an object
  };
  /// Items that follow one another.
  using Take = std::function<bool(const std::vector<Item>&)>;

  /// Reads up to the list, which is the member of that name of the file's object. Null where there is none within the
  /// first 64 MB.
  [[nodiscard]] static auto open(const std::filesystem::path& path, std::string_view member)
      -> std::unique_ptr<JsonList>;

  /// Calls `take` with all items, on all threads and in any order, until it returns false. False then, and where the
  /// list has anything but objects or does not end. What is inside an item is for `take` to check. To be called once.
  [[nodiscard]] auto each(const Take& take) -> bool;

  /// What is before the items, with the opening bracket, and after them, with the closing one. The two together are the
  /// file without the items. The second is there after each().
  [[nodiscard]] auto head() const -> const std::string& { return head_; }
  [[nodiscard]] auto tail() const -> const std::string& { return tail_; }

 private:
  struct Batch {
    std::size_t first = 0;
    std::uint64_t offset = 0;
    std::string text;
    std::vector<std::pair<std::size_t, std::size_t>> items;  ///< in the text, from and to
  };
  explicit JsonList(const std::filesystem::path& path) : file_(path, std::ios::binary) {}
  auto read_more() -> bool;
  auto next_batch() -> Batch;

  std::ifstream file_;
  std::string head_, tail_;
  std::string text_;          ///< that was read, and is of no batch yet
  std::uint64_t offset_ = 0;  ///< of that text in the file
  std::size_t number_ = 0;    ///< of the next item
  bool ended_ = false, good_ = true;
};

}  // namespace mansard::formats
