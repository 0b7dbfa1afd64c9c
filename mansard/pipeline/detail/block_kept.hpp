// A block's result as it is kept: in the block's own frame, before it is placed.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "mansard/pipeline/detail/block_run.hpp"
#include "mansard/pipeline/kept.hpp"

namespace mansard::pipeline::detail {

/// Every option with its value, but those of some modules.
[[nodiscard]] auto options_but(const Options& options, std::initializer_list<std::string_view> modules) -> std::string;

/// The part of a block's key that all blocks of a run share.
[[nodiscard]] auto key_of(const Options& options, Keep keep) -> BlockKey;
/// The whole key of a block in its own frame.
[[nodiscard]] auto key_of(const block::Block& own, BlockKey shared) -> BlockKey;

[[nodiscard]] auto bytes_of(const BlockResult& result) -> std::string;
/// None where the bytes are of something else.
[[nodiscard]] auto result_of(std::string_view bytes) -> std::optional<BlockResult>;

}  // namespace mansard::pipeline::detail
