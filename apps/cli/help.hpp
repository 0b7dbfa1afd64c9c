// `--help` and `--help-all`: what a person reads first, within 100 columns.
#pragma once

#include <string>

#include "apps/cli/grammar.hpp"

namespace mansard::cli {

/// `mansard --help`: the verbs by task.
/// Without any argument: what to do first.
[[nodiscard]] auto first_words() -> std::string;
[[nodiscard]] auto overview() -> std::string;

/// `mansard VERB --help`: usage, arguments, the most used options and examples, on one screen.
[[nodiscard]] auto short_help(const Form& form) -> std::string;

/// `mansard VERB --help-all`: every option that the verb reads, by module, but the advanced ones.
[[nodiscard]] auto full_help(const Form& form) -> std::string;

}  // namespace mansard::cli
