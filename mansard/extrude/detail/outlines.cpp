#include "mansard/extrude/detail/outlines.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

namespace mansard::extrude::detail {
namespace {

/// All that canonical() goes by, but for the tracks themselves.
struct Key {
  std::vector<SourceRing> rings;
  std::vector<std::uint32_t> track_of_profile;
  std::vector<std::uint32_t> shape_of_track;  ///< the first track that climbs alike
  std::array<double, 5> options{};
  friend auto operator==(const Key&, const Key&) -> bool = default;
};

struct Kept {
  Key key;
  std::optional<Footprint> footprint;
  std::string why;
};

/// The tracks of a source in the order in which its profiles name them, as canonical() has them.
auto tracks_of(const Source& source, Key& key) -> std::vector<Track> {
  std::vector<Track> tracks;
  for (std::size_t p = 0; p < source.profiles.size(); ++p) {
    const auto known =
        static_cast<std::size_t>(std::ranges::find(source.profiles, source.profiles[p]) - source.profiles.begin());
    if (known < p) {
      key.track_of_profile.push_back(key.track_of_profile[known]);
      continue;
    }
    Track track = track_of(source.profiles[p]);
    const auto same = std::ranges::find(tracks, track);
    key.track_of_profile.push_back(static_cast<std::uint32_t>(same - tracks.begin()));
    if (same == tracks.end()) tracks.push_back(std::move(track));
  }
  for (const Track& track : tracks)
    key.shape_of_track.push_back(static_cast<std::uint32_t>(
        std::ranges::find_if(tracks, [&](const Track& other) { return same_shape(track, other); }) - tracks.begin()));
  return tracks;
}

}  // namespace

auto canonical_outline(const Source& source, const Options& options, std::string& why) -> const Footprint* {
  constexpr std::size_t most_kept = 8;  // what a search sketches by turns: few outlines, some with few profiles alike
  thread_local std::vector<Kept> kept;
  Key key{source.rings,
          {},
          {},
          {options.merge_angle, options.tolerance, options.lines.share_move, options.lines.share_turn,
           options.lines.min_stretch}};
  auto tracks = tracks_of(source, key);
  auto found = std::ranges::find(kept, key, &Kept::key);
  if (found == kept.end()) {
    if (kept.size() == most_kept) kept.pop_back();
    std::string reason;
    auto footprint = canonical(source, options, reason);
    kept.push_back({std::move(key), std::move(footprint), std::move(reason)});
    found = std::prev(kept.end());
  }
  std::rotate(kept.begin(), found, std::next(found));  // the last used first
  Kept& one = kept.front();
  why = one.why;
  if (!one.footprint) return nullptr;
  one.footprint->tracks = std::move(tracks);
  return &*one.footprint;
}

}  // namespace mansard::extrude::detail
