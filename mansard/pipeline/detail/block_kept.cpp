#include "mansard/pipeline/detail/block_kept.hpp"

#include <algorithm>

#include "mansard/base/pack.hpp"
#include "mansard/formats/hash.hpp"

namespace mansard::pipeline::detail {

auto options_but(const Options& options, std::initializer_list<std::string_view> modules) -> std::string {
  Options copy = options;
  std::string used;
  for (const auto& list : option_lists(copy)) {
    if (std::ranges::find(modules, list.module()) != modules.end()) continue;
    for (const auto& option : list.options()) used += list.module() + "." + option.name + "=" + option.get() + "\n";
  }
  return used;
}

auto key_of(const Options& options, Keep keep) -> BlockKey {
  // What is read shows in the block; how it is written does not matter to it.
  const auto used = options_but(options, {"ingest", "cloud", "derive", "write", "roof", "texture", "terrain"}) +
                    (keep == Keep::segmentations ? "segmentations" : "models");
  return {program_hash(), formats::sha256(used), {}, {}};
}

auto key_of(const block::Block& own, BlockKey shared) -> BlockKey {
  std::string footprints;
  base::pack(own.name, footprints);
  base::pack(own.members, footprints);
  base::pack(own.outline, footprints);
  base::pack(own.beside, footprints);
  base::pack(own.warnings, footprints);
  std::string mesh;
  base::pack(own.mesh, mesh);
  base::pack(own.ground, mesh);
  base::pack(own.ground_known, mesh);
  shared.footprints = formats::sha256(footprints);
  shared.mesh = formats::sha256(mesh);
  return shared;
}

auto bytes_of(const BlockResult& result) -> std::string { return base::packed(result); }

auto result_of(std::string_view bytes) -> std::optional<BlockResult> {
  BlockResult result;
  base::Unpacker from(bytes);
  if (!from.take(result) || !from.done()) return std::nullopt;
  return result;
}

}  // namespace mansard::pipeline::detail
