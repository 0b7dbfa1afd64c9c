// What people decided about the models of a project. One file, review.json, has the decisions of all runs, by building.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/attributes.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/frame.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::report {

enum class Verdict : std::uint8_t { right, wrong, later };
inline constexpr std::array<std::string_view, 3> verdict_names{"right", "wrong", "later"};
[[nodiscard]] constexpr auto to_string(Verdict verdict) -> std::string_view {
  return verdict_names[static_cast<std::size_t>(verdict)];
}
[[nodiscard]] auto verdict_of(std::string_view name) -> std::optional<Verdict>;

struct Decision {
  std::string building;  ///< id
  Verdict verdict = Verdict::later;
  std::string note;      ///< empty: none
  std::string reviewer;  ///< empty: unknown
  std::string time;      ///< ISO 8601, UTC
  std::string model;     ///< model_key of the building that was looked at
  friend auto operator==(const Decision&, const Decision&) -> bool = default;
};
using Decisions = std::map<std::string, Decision, std::less<>>;  ///< by building

inline constexpr const char* review_file = "review.json";

/// One decision a line. Fails to be read with "review-file", which names the place.
[[nodiscard]] auto review_text(const Decisions& decisions) -> std::string;
[[nodiscard]] auto parse_review(std::string_view text, const std::string& subject) -> base::Result<Decisions>;
/// Of a file, or of the folder of a project; a project without such a file has no decisions. Fails with "review-file",
/// "file-missing", "file-read".
[[nodiscard]] auto read_review(const std::filesystem::path& path) -> base::Result<Decisions>;

/// The decisions of both. Where both have one, the later counts. Guarantees: 1 the order of the two does not matter ·
/// 2 merging a file with itself changes nothing.
struct MergedReview {
  Decisions decisions;
  std::size_t added = 0;     ///< that the first did not have
  std::size_t replaced = 0;  ///< of the first, by later ones
  struct Conflict {
    Decision kept, dropped;
  };
  std::vector<Conflict> conflicts;  ///< buildings on which the two disagree, by id
};
[[nodiscard]] auto merged(const Decisions& first, const Decisions& second) -> MergedReview;

/// Hash of the plans of a building's parts, to the millimetre, in the coordinates of its files: the same in every run,
/// project and frame that has the same model.
[[nodiscard]] auto model_key(std::span<const model::Plan* const> parts, const model::Frame& frame) -> std::string;

/// The attributes of a building with such a decision: ms_review and those beside it.
[[nodiscard]] auto attributes_of(const Decision& decision) -> model::Attributes;
/// Replaces those that a building has; none: removes them.
void set_review(model::Attributes& attributes, const Decision* decision);
[[nodiscard]] auto has_review(const model::Attributes& attributes) -> bool;
[[nodiscard]] auto review_attributes() -> std::vector<formats::Attribute>;

}  // namespace mansard::report
