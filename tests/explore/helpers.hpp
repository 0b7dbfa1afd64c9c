// A strict reader of XML as far as the reports use it, and two houses as files.
#pragma once

#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/scratch.hpp"
#include "lab/explore/explore.hpp"

namespace mansard::test {

/// Takes a document apart: every element closed in order, every attribute quoted and given once, every '&' the
/// beginning of an entity. `error` is empty when all is well.
class Xml {
 public:
  struct Element {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    [[nodiscard]] auto get(std::string_view key) const -> std::string {
      for (const auto& [own, value] : attributes)
        if (own == key) return value;
      return {};
    }
  };

  explicit Xml(std::string_view text) : text_(text) {
    if (text_.starts_with("<!DOCTYPE html>\n")) at_ = 16;
    while (error.empty() && at_ < text_.size()) text_[at_] == '<' ? markup() : words();
    if (error.empty() && !open_.empty()) error = "<" + open_.back() + "> is not closed";
    if (error.empty() && elements.empty()) error = "there is no element";
  }

  [[nodiscard]] auto count(std::string_view name) const -> std::size_t {
    std::size_t n = 0;
    for (const auto& element : elements) n += element.name == name ? 1 : 0;
    return n;
  }

  std::vector<Element> elements;
  std::string words_of_all;  ///< every text, entities read
  std::string error;

 private:
  auto fail(const std::string& what) -> bool {
    if (error.empty()) error = what + " at " + std::to_string(at_) + ": " + std::string(text_.substr(at_, 40));
    return false;
  }

  auto entity() -> std::string {
    using Named = std::pair<std::string_view, const char*>;
    static constexpr std::array<Named, 5> known{
        Named{"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
    for (const auto& [name, value] : known)
      if (text_.substr(at_).starts_with(name)) {
        at_ += name.size();
        return value;
      }
    fail("a bare '&'");
    return {};
  }

  void words() {
    if (open_.empty() && !std::isspace(static_cast<unsigned char>(text_[at_]))) {
      fail("text outside of everything");
      return;
    }
    if (text_[at_] == '&') {
      words_of_all += entity();
      return;
    }
    if (text_[at_] == '>' && open_.back() != "style") fail("a bare '>'");
    words_of_all += text_[at_++];
  }

  auto name() -> std::string {
    const auto from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-')) ++at_;
    if (from == at_) fail("no name");
    return std::string(text_.substr(from, at_ - from));
  }

  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  auto take(char c) -> bool {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void attribute(Element& element) {
    auto key = name();
    if (!take('=') || !take('"')) {
      fail("an attribute without a quoted value");
      return;
    }
    if (!element.get(key).empty()) fail("an attribute given twice");
    std::string value;
    while (error.empty() && at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '<') fail("'<' in a value");
      value += text_[at_] == '&' ? entity() : std::string(1, text_[at_++]);
    }
    if (!take('"')) fail("a value without an end");
    element.attributes.emplace_back(std::move(key), std::move(value));
  }

  void markup() {
    ++at_;
    if (take('/')) {
      const auto closed = name();
      if (!take('>')) fail("'>' expected");
      if (open_.empty() || open_.back() != closed) {
        fail("</" + closed + "> closes nothing");
        return;
      }
      open_.pop_back();
      return;
    }
    Element element{name(), {}};
    for (skip(); error.empty() && at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/'; skip())
      attribute(element);
    const bool empty = take('/');
    if (!take('>')) fail("'>' expected");
    if (!empty) open_.push_back(element.name);
    elements.push_back(std::move(element));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
};

/// Two gabled houses wall to wall, 5 and 7 m to the eaves, as OBJ and GeoJSON in a folder of their own.
class Houses {
 public:
  Houses() {
    std::ofstream mesh(folder_ / "mesh.obj");
    mesh << "v -20 -20 0\nv 44 -20 0\nv 44 40 0\nv -20 40 0\nf 1 2 3 4\n";
    const auto house = [&](int first, double x, double eaves) {
      for (const double z : {0.0, eaves})
        for (const auto& [dx, y] : {std::pair{0.0, 0.0}, {12.0, 0.0}, {12.0, 8.0}, {0.0, 8.0}})
          mesh << "v " << x + dx << ' ' << y << ' ' << z << '\n';
      mesh << "v " << x << " 4 " << eaves + 3 << "\nv " << x + 12 << " 4 " << eaves + 3 << '\n';
      const std::vector<std::vector<int>> faces{{0, 1, 5, 4},    {1, 2, 6, 9, 5}, {2, 3, 7, 6},
                                                {3, 0, 4, 8, 7}, {4, 5, 9, 8},    {6, 7, 8, 9}};
      for (const auto& face : faces) {
        mesh << 'f';
        for (const int corner : face) mesh << ' ' << first + corner;
        mesh << '\n';
      }
    };
    house(5, 0, 5);
    house(15, 12, 7);
    const auto feature = [](const std::string& id, const std::string& x0, const std::string& x1) {
      return R"({"type":"Feature","properties":{"id":")" + id + R"("},"geometry":{"type":"Polygon","coordinates":[[[)" +
             x0 + ",0],[" + x1 + ",0],[" + x1 + ",8],[" + x0 + ",8],[" + x0 + ",0]]]}}";
    };
    std::ofstream(folder_ / "footprints.geojson")
        << R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}},)"
        << R"("features":[)" << feature("low", "0", "12") << ',' << feature("high", "12", "24") << "]}";
  }
  Houses(const Houses&) = delete;
  auto operator=(const Houses&) -> Houses& = delete;

  [[nodiscard]] auto dataset(std::string name) const -> explore::Dataset {
    return {std::move(name), {folder_ / "mesh.obj"}, folder_ / "footprints.geojson", {}, {}};
  }

 private:
  Scratch folder_;
};

}  // namespace mansard::test
