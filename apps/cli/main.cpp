// mansard: verb, inputs, -o OUTPUT.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <set>
#include <system_error>
#include <vector>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/help.hpp"
#include "apps/cli/last_resort.hpp"
#include "apps/cli/layout.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/verbs.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/given.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {
namespace {

base::Cancel cancel;  // NOLINT: a signal handler can only reach a global

/// A standard stream that whoever called has closed would give its number to the first file that is opened, and what
/// is printed would go into it.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF) (void)!::open("/dev/null", O_RDWR);
}

/// What was printed is a result too: a full disk must not pass for success. A reader that closes the pipe early, as
/// `head` does, is no failure.
auto printed(int code) -> int {
  const bool failed = std::fflush(stdout) != 0;
  const std::string why = failed ? std::strerror(errno) : "";
  if (!failed && std::ferror(stdout) == 0) return code;
  pollfd out{STDOUT_FILENO, 0, 0};
  if (::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0) return code;
  return give_up(base::error(
      "file-write",
      "cannot be written completely" + (why.empty() ? why : ": " + why) + "; redirect it to a place with free space",
      "standard output"));
}

/// "--sweep-line-gap" is "sweep.line_gap".
auto key_of(std::string name) -> std::string {
  name.erase(0, std::min(name.size(), name.find_first_not_of('-')));
  std::ranges::replace(name, '-', '_');
  if (const auto end = name.find('_'); end != std::string::npos) name[end] = '.';
  return name;
}

/// Options that are of another verb, and misspelt ones, with the nearest known one.
auto unknown_option(const Form& verb, const std::string& name, const std::vector<Form>& forms) -> base::Diagnostic {
  std::vector<std::string> others, known;
  std::set<std::string> modules;
  for (const auto& form : forms)
    for (const auto& term : form.options)
      if (std::ranges::find(term.names, name) != term.names.end()) {
        others.push_back(form.verb);
        modules.insert(term.module);
      }
  if (!others.empty()) {
    // --seed is of one module here and of another there, and --lod of none.
    const auto module = modules.size() == 1 ? *modules.begin() : "";
    return base::error("option-verb",
                       "'mansard " + verb.verb + "' does not " +
                           (module.empty() ? "have this option" : "read the options of the module " + module) +
                           (others.size() > 1 ? "; verbs that do: " : "; the verb that does: ") + listed(others),
                       name);
  }
  if (auto why = pipeline::why_removed(key_of(name)); !why.empty())
    return base::error("option-unknown", std::move(why), name);
  for (const auto& term : verb.options)
    for (const auto& spelling : term.names)
      if (spelling.starts_with("--")) known.push_back(spelling);
  const auto nearest = base::nearest_word(name, known);
  return base::error("option-unknown",
                     "unknown option; see 'mansard " + verb.verb + " --help-all'" + base::did_you_mean(nearest), name);
}

/// What no option or argument of the verb has taken. That "--" ends the options is no word of its own.
auto left_over(const CLI::App& verb) -> std::vector<std::string> {
  auto words = verb.remaining();
  if (const auto mark = std::ranges::find(words, "--"); mark != words.end()) words.erase(mark);
  return words;
}

auto unknown_options(const CLI::App& app, const CLI::App& verb) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> unknown;
  for (const auto& word : left_over(verb)) {
    if (!word.starts_with("-") || word.size() < 2 || base::to_number(word)) continue;
    const auto name = word.substr(0, word.find('='));
    unknown.push_back(unknown_option(form_of(verb), name, forms_of(app)));
  }
  return unknown;
}

/// What a word that is no verb may have been meant to be.
auto unknown_verb(const std::string& word) -> base::Diagnostic {
  std::vector<std::string> names;
  for (const auto& entry : catalogue()) names.push_back(entry.name);
  const std::string what = word.empty()            ? "no verb is given"
                           : word.starts_with("-") ? "a verb must come before the options"
                                                   : "unknown verb";
  return base::error("usage", what + "; see 'mansard --help'" + base::did_you_mean(base::nearest_word(word, names)),
                     word);
}

auto parse_failure(const CLI::App& app, const CLI::ParseError& e, const std::string& first)
    -> std::vector<base::Diagnostic> {
  if (app.get_subcommands().empty()) return {unknown_verb(first)};
  const auto& verb = *app.get_subcommands().front();
  if (auto unknown = unknown_options(app, verb); !unknown.empty()) return unknown;
  const bool of_value = dynamic_cast<const CLI::ValidationError*>(&e) != nullptr ||
                        dynamic_cast<const CLI::ConversionError*>(&e) != nullptr;
  // What is missing is seen best in how the verb is called.
  const auto call =
      dynamic_cast<const CLI::RequiredError*>(&e) == nullptr ? "" : ": " + entry_of(verb.get_name()).usage.front();
  return {base::error(of_value ? "option-value" : "usage",
                      std::string(e.what()) + call + "; see 'mansard " + verb.get_name() + " --help'")};
}

auto help_of(const CLI::App& app, bool all) -> std::string {
  if (app.get_subcommands().empty()) return overview();
  const auto form = form_of(*app.get_subcommands().front());
  return all ? full_help(form) : short_help(form);
}

/// The command line with `--flag` as `--flag=true`, unless the word after it says true or false: the word would be
/// taken as the flag's value else, whatever it is.
auto with_flags_closed(const std::vector<Verb>& verbs, int argc, char** argv) -> std::vector<std::string> {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return words;
  const auto verb = std::ranges::find(verbs, words.front(), [](const Verb& v) { return v.app->get_name(); });
  if (verb == verbs.end()) return words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto* option = words[i].starts_with("--") ? verb->app->get_option_no_throw(words[i]) : nullptr;
    const bool flag =
        option != nullptr && option->get_items_expected_min() == 0 && option->get_items_expected_max() == 1;
    const bool says = i + 1 < words.size() && (words[i + 1] == "true" || words[i + 1] == "false");
    if (flag && !says) words[i] += "=true";
  }
  return words;
}

/// Of whatever is read, before the verb begins. Outputs are checked by the verbs.
auto check_inputs(const std::vector<std::string>& typed) -> base::Result<void> {
  constexpr std::array outputs{"-o", "--output", "--report", "--export-mps", "--terrain-out"};
  for (std::size_t i = 2; i < typed.size(); ++i) {
    const auto value = typed[i].starts_with("--") ? typed[i].find('=') : std::string::npos;
    if (std::ranges::find(outputs, value == std::string::npos ? typed[i - 1] : typed[i].substr(0, value)) !=
        outputs.end())
      continue;
    const auto word = value == std::string::npos ? typed[i] : typed[i].substr(value + 1);
    if (auto checked = formats::check_given(word); !checked) return checked;
  }
  return {};
}

auto run(int argc, char** argv) -> int {
  CLI::App app("", "mansard");
  app.set_version_flag("--version", std::string("mansard ") + MANSARD_VERSION);
  app.set_help_all_flag("--help-all");
  app.option_defaults()->always_capture_default();
  app.require_subcommand(1);
  const std::vector<std::string> typed(argv, argv + argc);
  const std::vector<Verb> verbs{reconstruct_verb(app, typed, cancel),
                                extrude_verb(app, cancel),
                                convert_verb(app, cancel),
                                info_verb(app, cancel),
                                doctor_verb(app, cancel),
                                evaluate_verb(app, cancel),
                                compare_verb(app, cancel),
                                report_verb(app, cancel),
                                segment_verb(app, typed, cancel),
                                label_verb(app, cancel),
                                new_verb(app, cancel),
                                serve_verb(app, cancel),
                                review_verb(app),
                                simulate_verb(app, cancel),
                                explore_verb(app, typed, cancel),
                                cluster_verb(app),
                                status_verb(app),
                                options_verb(app),
                                explain_verb(app),
                                completion_verb(app),
                                manual_verb(app)};
  if (argc <= 1) {
    std::fputs(first_words().c_str(), stdout);
    return usage;
  }
  for (const auto& verb : verbs) verb.app->allow_extras();  // so that we can suggest the right one
  try {
    auto words = with_flags_closed(verbs, argc, argv);
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::CallForHelp&) {
    std::fputs(help_of(app, false).c_str(), stdout);
    return all_done;
  } catch (const CLI::CallForAllHelp&) {
    std::fputs(help_of(app, true).c_str(), stdout);
    return all_done;
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return give_up(parse_failure(app, e, argc > 1 ? argv[1] : ""));
  }
  for (const auto& verb : verbs) {
    if (!verb.app->parsed()) continue;
    if (const auto unknown = unknown_options(app, *verb.app); !unknown.empty()) return give_up(unknown);
    if (const auto more = left_over(*verb.app); !more.empty())
      return give_up(
          base::error("usage", "unexpected argument; see 'mansard " + verb.app->get_name() + " --help'", more.front()));
    if (const auto ready = check_inputs(typed); !ready) return give_up(ready.errors());
    if (verb.app->get_name() == "serve") go_on_without_memory();  // and it ends in its own time
    else stop_in_time();
    return verb.run();
  }
  return usage;
}

}  // namespace
}  // namespace mansard::cli

auto main(int argc, char** argv) -> int {
  namespace base = mansard::base;
  namespace cli = mansard::cli;
  cli::hold_standard_streams();
  // `mansard … 2>&1 | head` must not end a run between two files.
  std::signal(SIGPIPE, SIG_IGN);
  cli::stop_on_signals(cli::cancel);
  cli::end_without_memory();
  cli::fail_writes_beyond_limit();
  const struct Tidy {
    ~Tidy() { cli::remove_folders_left_empty(); }
  } tidy;
  try {
    return cli::printed(cli::run(argc, argv));
  } catch (const std::bad_alloc&) {
    return cli::give_up(base::error("memory", "out of memory; process a smaller area (--bbox)"));
  } catch (const std::system_error& e) {
    if (e.code() != std::errc::resource_unavailable_try_again && e.code() != std::errc::not_enough_memory)
      return cli::give_up(base::error("bug", std::string(e.what()) + "; please report it with the command line"));
    return cli::give_up(
        base::error("memory", "there is no memory for another thread, or too many threads run; use fewer with --jobs"));
  } catch (const std::exception& e) {
    return cli::give_up(base::error("bug", std::string(e.what()) + "; please report it with the command line"));
  }
}
