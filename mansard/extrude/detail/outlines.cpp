#include "mansard/extrude/detail/outlines.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

namespace mansard::extrude::detail {
namespace {

/// Which of a source's profiles are one track, and which tracks climb alike.
struct Pattern {
  std::vector<std::uint32_t> track_of_profile;
  std::vector<std::uint32_t> shape_of_track;  ///< the first track that climbs alike
  friend auto operator==(const Pattern&, const Pattern&) -> bool = default;
};

/// The outline of a source, and all that canonical() made it from.
struct Kept {
  std::vector<SourceRing> rings;
  std::array<double, 5> options{};
  Pattern pattern;                       ///< where the lines depend on it, or there are none
  std::vector<model::Profile> profiles;  ///< of the tracks, as the footprint was last asked for
  std::optional<Footprint> footprint;
  std::string why;
};

/// The tracks of a source in the order in which its profiles name them, as canonical() has them, and for each the first
/// profile. Those of the source before, which are moved out, are not made again.
struct Tracks {
  std::vector<Track> tracks;
  std::vector<model::Profile> profiles;
  Pattern pattern;

  Tracks(const Source& source, Kept* before) {
    for (std::size_t p = 0; p < source.profiles.size(); ++p) {
      const auto& profile = source.profiles[p];
      const auto known =
          static_cast<std::size_t>(std::ranges::find(source.profiles, profile) - source.profiles.begin());
      if (known < p) {
        pattern.track_of_profile.push_back(pattern.track_of_profile[known]);
        continue;
      }
      Track track = taken(profile, before);
      const auto same = std::ranges::find(tracks, track);
      pattern.track_of_profile.push_back(static_cast<std::uint32_t>(same - tracks.begin()));
      if (same != tracks.end()) continue;
      tracks.push_back(std::move(track));
      profiles.push_back(profile);
    }
    for (const Track& track : tracks)
      pattern.shape_of_track.push_back(static_cast<std::uint32_t>(
          std::ranges::find_if(tracks, [&](const Track& other) { return same_shape(track, other); }) - tracks.begin()));
    if (before != nullptr) before->profiles.clear();  // of tracks that it may not have any more
  }

 private:
  static auto taken(const model::Profile& profile, Kept* before) -> Track {
    if (before == nullptr || !before->footprint) return track_of(profile);
    const auto at = std::ranges::find(before->profiles, profile);
    if (at == before->profiles.end()) return track_of(profile);
    return std::move(before->footprint->tracks[static_cast<std::size_t>(at - before->profiles.begin())]);
  }
};

/// Gives the edges the tracks of their profiles.
void put_on_tracks(Footprint& footprint, const Source& source, const Pattern& pattern) {
  for (std::size_t r = 0; r < footprint.rings.size(); ++r)
    for (auto& edge : footprint.rings[r]) {
      const auto& names = source.rings[r].edge;
      const auto at = static_cast<std::size_t>(std::ranges::find(names, edge.provenance.edge) - names.begin());
      edge.track = pattern.track_of_profile[source.rings[r].profile[at]];
    }
}

}  // namespace

auto canonical_outline(const Source& source, const Options& options, std::string& why) -> const Footprint* {
  constexpr std::size_t most_kept = 8;  // what a search sketches by turns
  thread_local std::vector<Kept> kept;
  const std::array<double, 5> numbers{options.merge_angle, options.tolerance, options.lines.share_move,
                                      options.lines.share_turn, options.lines.min_stretch};
  Tracks tracks(source, kept.empty() ? nullptr : &kept.front());
  auto found = std::ranges::find_if(kept, [&](const Kept& one) {
    return one.options == numbers && one.rings == source.rings &&
           ((one.footprint && !one.footprint->by_profiles) || one.pattern == tracks.pattern);
  });
  if (found == kept.end()) {
    if (kept.size() == most_kept) kept.pop_back();
    std::string reason;
    auto footprint = canonical(source, options, reason);
    kept.push_back({source.rings, numbers, tracks.pattern, {}, std::move(footprint), std::move(reason)});
    found = std::prev(kept.end());
  }
  std::rotate(kept.begin(), found, std::next(found));  // the last used first
  Kept& one = kept.front();
  why = one.why;
  if (!one.footprint) return nullptr;
  if (!one.footprint->by_profiles) put_on_tracks(*one.footprint, source, tracks.pattern);
  one.footprint->tracks = std::move(tracks.tracks);
  one.profiles = std::move(tracks.profiles);
  return &*one.footprint;
}

}  // namespace mansard::extrude::detail
