// The buildings of a run as it made them, before edits: all in memory, or of a large run read from its file on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "apps/server/run_index.hpp"
#include "mansard/base/result.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/plans_file.hpp"
#include "mansard/model/city.hpp"

namespace mansard::server {

/// Thrown where the file of a run that was opened cannot be read any more.
struct Unreadable : std::runtime_error {
  explicit Unreadable(base::Diagnostic diagnostic)
      : std::runtime_error(diagnostic.message), why(std::move(diagnostic)) {}
  base::Diagnostic why;
};

/// Every function may be called from any thread, and where it reads may throw Unreadable.
class RunBuildings final : public edit::FirstPlans {
 public:
  explicit RunBuildings(model::City city);
  /// The columns of the index that are of plans.json are taken from it.
  RunBuildings(std::unique_ptr<formats::PlansFile> file, RunIndex& index);

  /// Whether they are in memory.
  [[nodiscard]] auto in_memory() const -> bool { return file_ == nullptr; }
  [[nodiscard]] auto size() const -> std::size_t { return in_memory() ? city_.buildings.size() : ids_.size(); }
  [[nodiscard]] auto id(std::size_t building) const -> const std::string& {
    return in_memory() ? city_.buildings[building].id : ids_[building];
  }
  [[nodiscard]] auto frame() const -> const model::Frame& { return city_.frame; }
  [[nodiscard]] auto made_by() const -> const model::MadeBy& { return city_.made_by; }

  /// With attributes.
  [[nodiscard]] auto building(std::size_t building) const -> std::shared_ptr<const model::Building>;
  /// Those used last are kept.
  [[nodiscard]] auto plans(std::size_t building) const -> edit::Parts;
  [[nodiscard]] auto parts(std::string_view id) const -> edit::Parts override;
  /// shapes_of() its plans.
  [[nodiscard]] auto shapes(std::size_t building) const -> std::string_view;
  /// Whether it was edited before it was exported and opened again.
  [[nodiscard]] auto marked(std::size_t building) const -> bool;
  /// Of the attributes of buildings, then of parts, in the order in which they come.
  [[nodiscard]] auto attributes() const -> const std::vector<std::string>& { return attributes_; }

  /// Calls take(number, building) with all, on all threads and in any order; of those that are not in memory ids and
  /// attributes only.
  void each(const std::function<void(std::size_t, const model::Building&)>& take) const;
  /// All of them, in memory for an export.
  [[nodiscard]] auto city() const -> std::shared_ptr<const model::City>;

 private:
  model::City city_;  // without buildings where there is a file
  std::unique_ptr<formats::PlansFile> file_;
  std::vector<std::string> ids_;
  std::vector<formats::PlansFile::Place> places_;
  std::vector<std::uint8_t> marked_;
  std::string shapes_;
  std::vector<std::uint64_t> shape_ends_;
  std::vector<std::string> attributes_;
  std::unordered_map<std::string_view, std::size_t> at_;  // by id

  using Kept = std::list<std::pair<std::size_t, edit::Parts>>;
  mutable std::mutex mutex_;
  mutable Kept kept_;  // of a file, the last one first
  mutable std::unordered_map<std::size_t, Kept::iterator> kept_at_;
};

}  // namespace mansard::server
