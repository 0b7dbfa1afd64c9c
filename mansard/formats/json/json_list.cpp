#include "mansard/formats/json_list.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <utility>

#include "mansard/base/run.hpp"

namespace mansard::formats {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20U;  // bytes that are read at once
constexpr std::size_t longest_head = std::size_t{64} << 20U;
constexpr std::size_t longest_item = std::size_t{256} << 20U;

auto is_blank(char c) -> bool { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Characters that matter outside of strings.
constexpr auto structure = [] {
  std::array<bool, 256> is{};
  for (const unsigned char c : {'"', '{', '}', '[', ']'}) is[c] = true;
  return is;
}();

/// Walks through a text of JSON that comes in pieces.
class Walk {
 public:
  [[nodiscard]] auto depth() const -> int { return depth_; }
  [[nodiscard]] auto in_string() const -> bool { return in_string_; }
  /// Goes on from `at`, to after the next bracket; the end of the text where there is none.
  auto to_bracket(const std::string& text, std::size_t at) -> std::size_t {
    const char* p = text.data() + at;
    const char* const end = text.data() + text.size();
    while (p < end) {
      if (escaped_) {
        escaped_ = false;
        ++p;
        continue;
      }
      if (in_string_) {
        while (p < end && *p != '"' && *p != '\\') ++p;
        if (p == end) break;
        if (*p == '\\') escaped_ = true;
        else in_string_ = false;
        ++p;
        continue;
      }
      while (p < end && !structure[static_cast<unsigned char>(*p)]) ++p;
      if (p == end) break;
      const char c = *p++;
      if (c == '"') {
        in_string_ = true;
        continue;
      }
      depth_ += c == '{' || c == '[' ? 1 : -1;
      return static_cast<std::size_t>(p - text.data());
    }
    return text.size();
  }

 private:
  int depth_ = 0;
  bool in_string_ = false, escaped_ = false;
};

/// Whether a text ends with "name": [
auto opens(std::string_view text, std::string_view name) -> bool {
  const auto skip_blanks = [&] {
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  };
  if (!text.ends_with('[')) return false;
  text.remove_suffix(1);
  skip_blanks();
  if (!text.ends_with(':')) return false;
  text.remove_suffix(1);
  skip_blanks();
  return text.ends_with('"' + std::string(name) + '"');
}

}  // namespace

auto JsonList::read_more() -> bool {
  const auto before = text_.size();
  text_.resize(before + piece);
  file_.read(text_.data() + before, static_cast<std::streamsize>(piece));
  text_.resize(before + static_cast<std::size_t>(file_.gcount()));
  return text_.size() > before;
}

auto JsonList::open(const std::filesystem::path& path, std::string_view member) -> std::unique_ptr<JsonList> {
  std::unique_ptr<JsonList> list(new JsonList(path));
  Walk walk;
  for (std::size_t at = 0;;) {
    while (at == list->text_.size())
      if (at > longest_head || !list->read_more()) return nullptr;
    at = walk.to_bracket(list->text_, at);
    if (walk.depth() == 2 && !walk.in_string() && opens(std::string_view(list->text_).substr(0, at), member)) {
      list->head_ = list->text_.substr(0, at);
      list->text_.erase(0, at);
      list->offset_ = at;
      return list;
    }
    if (walk.depth() < 1 && at < list->text_.size()) return nullptr;
  }
}

/// Items up to about a piece of text; without any at the end.
auto JsonList::next_batch() -> Batch {
  Batch batch{number_, offset_, {}, {}};
  Walk walk;
  std::size_t at = 0, end = 0;  // `end`: of the last item
  while (!ended_ && good_ && end < piece) {
    // Between items.
    while (at < text_.size() && (is_blank(text_[at]) || (text_[at] == ',' && number_ > 0))) ++at;
    if (at == text_.size()) {
      if (!read_more()) good_ = false;
      continue;
    }
    if (text_[at] == ']') {
      ended_ = true;
      break;
    }
    if (text_[at] != '{') {
      good_ = false;
      break;
    }
    const auto from = at;
    walk = {};
    do {
      at = walk.to_bracket(text_, at);
      if (at == text_.size() && walk.depth() > 0 && (text_.size() > longest_item || !read_more())) good_ = false;
    } while (good_ && walk.depth() > 0);
    if (!good_) break;
    batch.items.emplace_back(from, at);
    end = at;
    ++number_;
  }
  const auto cut = ended_ ? at : end;
  batch.text = text_.substr(0, cut);
  text_.erase(0, cut);
  offset_ += cut;
  return batch;
}

auto JsonList::each(const Take& take) -> bool {
  std::mutex reading;
  std::atomic<bool> wanted = true;
  constexpr std::size_t most_threads = 64;
  base::parallel_for(most_threads, [&](std::size_t) {
    while (wanted) {
      Batch batch;
      {
        const std::scoped_lock lock(reading);
        if (ended_ || !good_) return;
        batch = next_batch();
      }
      std::vector<Item> items;
      items.reserve(batch.items.size());
      for (const auto& [from, to] : batch.items)
        items.push_back(
            {batch.first + items.size(), batch.offset + from, std::string_view(batch.text).substr(from, to - from)});
      if (!items.empty() && !take(items)) wanted = false;
    }
  });
  if (!wanted || !good_) return false;
  while (read_more()) {
    if (text_.size() > longest_head) return false;
  }
  tail_ = std::exchange(text_, {});
  return true;
}

}  // namespace mansard::formats
