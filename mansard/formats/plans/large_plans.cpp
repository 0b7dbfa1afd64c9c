// Large files of plans, read building by building: the text of one building is in memory at a time.
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "mansard/base/files.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/formats/plans/plan_text.hpp"
#include "mansard/formats/plans/quick_building.hpp"

namespace mansard::formats::detail {
namespace {

/// From here on a file is read in pieces; a smaller one is quicker as a whole.
constexpr std::uintmax_t large_from = std::uintmax_t{16} << 20U;
/// What stands before the buildings is never longer in a file that mansard wrote.
constexpr std::size_t longest_head = std::size_t{4} << 20U;

/// The characters of a file, in order.
class Characters {
 public:
  explicit Characters(const Path& path) : file_(path, std::ios::binary) {}
  /// None at the end.
  auto next() -> std::optional<char> {
    if (at_ == size_) {
      file_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
      size_ = static_cast<std::size_t>(file_.gcount());
      at_ = 0;
      if (size_ == 0) return std::nullopt;
    }
    return buffer_[at_++];
  }

 private:
  std::ifstream file_;
  std::string buffer_ = std::string(std::size_t{1} << 20U, '\0');
  std::size_t at_ = 0, size_ = 0;
};

/// Where in a text of JSON it is.
class Nesting {
 public:
  void take(char c) {
    if (escaped_) {
      escaped_ = false;
    } else if (in_string_) {
      if (c == '\\') escaped_ = true;
      else if (c == '"') in_string_ = false;
    } else if (c == '"') {
      in_string_ = true;
    } else if (c == '{' || c == '[') {
      ++depth_;
    } else if (c == '}' || c == ']') {
      --depth_;
    }
  }
  [[nodiscard]] auto depth() const -> int { return depth_; }
  [[nodiscard]] auto in_string() const -> bool { return in_string_; }

 private:
  int depth_ = 0;
  bool in_string_ = false, escaped_ = false;
};

class LargePlans : public CityReader {
 public:
  explicit LargePlans(const Path& path) : path_(path), characters_(path) {}

  /// Whether the file can be read in this way: its buildings come last, near their origin.
  auto open() -> bool {
    std::string head;
    Nesting nesting;
    while (!head.ends_with('[') || nesting.depth() != 2 || !names_buildings(head)) {
      const auto c = characters_.next();
      if (!c || head.size() > longest_head) return false;
      head += *c;
      nesting.take(*c);
    }
    try {
      const Json json = parse_json(head + "]}");
      header_ = read_header(Item{json, {}}, {"buildings"});
    } catch (const Defect&) {
      return false;
    }
    auto first = next();
    if (!first || !*first) return false;
    for (const auto& part : (*first)->parts)
      for (const auto p : part.plan.outer.points)
        if (std::max(std::abs(p.x), std::abs(p.y)) > near_origin) return false;
    first_ = std::move(*first);
    return true;
  }

  [[nodiscard]] auto header() const -> const Header& override { return header_; }
  [[nodiscard]] auto has_models() const -> bool override { return false; }
  [[nodiscard]] auto refused() const -> std::vector<base::Diagnostic> override {
    auto all = refused_;
    for (auto& part : all) part.subject = path_.string();
    return all;
  }
  [[nodiscard]] auto next() -> base::Result<std::optional<model::Building>> override {
    if (first_) return std::exchange(first_, std::nullopt);
    if (done_) return std::optional<model::Building>();
    auto c = characters_.next();
    while (c && (*c == ' ' || *c == '\n' || *c == '\r' || *c == '\t' || (*c == ',' && number_ > 0)))
      c = characters_.next();
    if (c == ']') {
      done_ = true;
      return rest() ? std::optional<model::Building>() : faults();
    }
    if (c != '{') return faults();
    std::string text(1, '{');
    Nesting nesting;
    nesting.take('{');
    while (nesting.depth() > 0) {
      c = characters_.next();
      if (!c) return faults();
      text += *c;
      nesting.take(*c);
    }
    if (model::Building building; quick_building(text, building) && ids_.insert(building.id).second) {
      ++number_;
      return std::optional(std::move(building));
    }
    try {
      const Json json = parse_json(text);
      const Place file, list{&file, "buildings", 0};
      const Item item{json, {&list, {}, number_++}};
      auto building = read_building(item, &refused_);
      if (!ids_.insert(building.id).second) item.member("id").refuse("an id that no other has");
      return std::optional(std::move(building));
    } catch (const Defect& defect) {
      if (defect.code == "write-plan-json") return faults();  // it counts bytes of the file
      return base::error(defect.code, defect.message, path_.string());
    }
  }

 private:
  static auto names_buildings(std::string_view head) -> bool {
    head.remove_suffix(1);
    const auto skip_blanks = [&] { head = head.substr(0, head.find_last_not_of(" \n\r\t") + 1); };
    skip_blanks();
    if (!head.ends_with(':')) return false;
    head.remove_suffix(1);
    skip_blanks();
    return head.ends_with("\"buildings\"");
  }

  /// Whether nothing but the end of the file's object comes.
  auto rest() -> bool {
    std::string left;
    for (auto c = characters_.next(); c && left.size() < 2; c = characters_.next())
      if (*c != ' ' && *c != '\n' && *c != '\r' && *c != '\t') left += *c;
    return left == "}";
  }

  /// What is wrong with the file, in the words for a file that is read as a whole.
  auto faults() -> base::Result<std::optional<model::Building>> {
    done_ = true;
    const auto text = base::read_file(path_);
    if (!text) return text.failure();
    std::vector<base::Diagnostic> refused;
    const auto city = parse_plans(*text, path_.string(), refused);
    if (!city) return city.failure();
    return base::error("write-plan-json", "the file was changed while it was read; try again", path_.string());
  }

  Path path_;
  Characters characters_;
  Header header_;
  std::optional<model::Building> first_;
  std::vector<base::Diagnostic> refused_;
  std::set<std::string> ids_;
  std::size_t number_ = 0;
  bool done_ = false;
};

}  // namespace

auto large_plans_reader(const Path& path) -> std::unique_ptr<CityReader> {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure) || std::filesystem::file_size(path, failure) < large_from ||
      failure)
    return nullptr;
  auto reader = std::make_unique<LargePlans>(path);
  return reader->open() ? std::move(reader) : nullptr;
}

}  // namespace mansard::formats::detail
