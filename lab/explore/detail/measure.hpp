// One run: a scene and a setting in, a row out.
#pragma once

#include "lab/explore/explore.hpp"

namespace mansard::explore::detail {

/// What the reference implementation's program would have for these faces: 6|F| + 4|H| + 6|H_int| + B, where F are the
/// faces inside, H the half-edges around them (both sides of an edge between two of them, which are H_int), B the bad
/// pairs; as it is in the reference: six colours a face, four variables a half-edge, an exclusive or per colour of an
/// interior one.
[[nodiscard]] auto reference_variables(const report::SegmentedBlock& block) -> std::size_t;

/// Fills in everything but dataset, setting and command. `number` names the pictures.
[[nodiscard]] auto measure(const model::Scene& scene, const pipeline::Options& options, const Request& request,
                           std::size_t number, const base::Run& run) -> Row;

/// The options with the values of a setting. Fails as pipeline::set_option does.
[[nodiscard]] auto with(pipeline::Options options, const Setting& setting) -> base::Result<pipeline::Options>;

/// The command that makes this run's models.
[[nodiscard]] auto command_of(const Dataset& dataset, pipeline::Options options) -> std::string;

/// Words as a shell takes them.
[[nodiscard]] auto quoted(const std::vector<std::string>& words) -> std::string;

/// The option's value as the request has it, for all options.
[[nodiscard]] auto values_of(pipeline::Options options) -> Setting;

}  // namespace mansard::explore::detail
