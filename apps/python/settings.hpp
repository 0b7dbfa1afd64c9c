// Options as keyword arguments: "sweep_gamma" is the option "sweep.gamma".
#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::python {

/// Keyword or alias → text, in the order given.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Sets the preset, unless empty, then the settings. Raises mansard.Error with all that cannot be taken.
void apply(std::vector<base::OptionList>& lists, const std::vector<pipeline::Preset>& presets,
           const std::string& preset, const Settings& settings);
[[nodiscard]] auto options_of(const std::string& preset, const Settings& settings) -> pipeline::Options;

void bind_settings(pybind11::module_& m);

}  // namespace mansard::python
