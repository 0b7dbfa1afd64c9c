// mansard: verb, inputs, -o OUTPUT.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "apps/cli/exit.hpp"
#include "apps/cli/output.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"

namespace mansard::cli {
namespace {

base::Cancel cancel;  // NOLINT: a signal handler can only reach a global

void on_interrupt(int) {
  if (cancel.requested()) ::_exit(cancelled);  // the second Ctrl-C ends it at once
  cancel.request();
}

/// A standard stream that whoever called has closed would give its number to the first file that is opened, and what
/// is printed would go into it.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF) (void)!::open("/dev/null", O_RDWR);
}

/// What was printed is a result too: a full disk must not pass for success. A reader that had enough, as `head` has, is
/// no failure.
auto printed(int code) -> int {
  const bool failed = std::fflush(stdout) != 0;
  const std::string why = failed ? std::strerror(errno) : "";
  if (!failed && std::ferror(stdout) == 0) return code;
  pollfd out{STDOUT_FILENO, 0, 0};
  if (::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0) return code;
  return give_up(base::error("file-write",
                             "cannot print everything" + (why.empty() ? why : ": " + why) +
                                 "; choose a place that can be written and has room",
                             "standard output"));
}

/// A misspelt option, with the nearest known one.
auto unknown_option(const CLI::App& verb) -> std::optional<base::Diagnostic> {
  for (const auto& word : verb.remaining()) {
    if (!word.starts_with("-") || word.size() < 2) continue;
    const auto name = word.substr(0, word.find('='));
    const auto nearest = base::nearest_word(name, Settings::names(verb));
    return base::error(
        "option-unknown",
        "there is no such option" + base::did_you_mean(nearest) + "; see 'mansard " + verb.get_name() + " --help-all'",
        name);
  }
  return std::nullopt;
}

auto run(int argc, char** argv) -> int {
  CLI::App app("City mesh and footprints in, labelled watertight building models out.", "mansard");
  app.set_version_flag("--version", std::string("mansard ") + MANSARD_VERSION);
  app.require_subcommand(1);
  app.footer("'mansard VERB --help' shows a verb's options; 'mansard explain CODE' what a diagnostic means.");
  const std::vector<Verb> verbs{reconstruct_verb(app, cancel),
                                segment_verb(app, cancel),
                                extrude_verb(app, cancel),
                                simulate_verb(app, cancel),
                                evaluate_verb(app, cancel),
                                label_verb(app, cancel),
                                explore_verb(app, {argv, argv + argc}, cancel),
                                convert_verb(app, cancel),
                                info_verb(app, cancel),
                                serve_verb(app, cancel),
                                options_verb(app),
                                explain_verb(app),
                                completion_verb(app),
                                manual_verb(app)};
  for (const auto& verb : verbs) verb.app->allow_extras();  // so that we can suggest the right one
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    for (const auto* verb : app.get_subcommands())
      if (const auto unknown = unknown_option(*verb)) return give_up(*unknown);
    std::vector<std::string> names;
    for (const auto& verb : verbs) names.push_back(verb.app->get_name());
    const std::string first = argc > 1 ? argv[1] : "";
    const auto nearest = app.get_subcommands().empty() ? base::nearest_word(first, names) : std::nullopt;
    const auto* verb = app.get_subcommands().empty() ? nullptr : app.get_subcommands().front();
    if (verb != nullptr && (dynamic_cast<const CLI::ValidationError*>(&e) != nullptr ||
                            dynamic_cast<const CLI::ConversionError*>(&e) != nullptr))
      return give_up(
          base::error("option-value", std::string(e.what()) + "; see 'mansard " + verb->get_name() + " --help'"));
    const std::string what = verb == nullptr && !first.empty() ? "'" + first + "' is no verb" : std::string(e.what());
    return give_up(base::error("usage", what + base::did_you_mean(nearest) + "; see 'mansard " +
                                            (verb != nullptr ? verb->get_name() + " " : "") + "--help'"));
  }
  for (const auto& verb : verbs) {
    if (!verb.app->parsed()) continue;
    if (const auto unknown = unknown_option(*verb.app)) return give_up(*unknown);
    if (!verb.app->remaining().empty())
      return give_up(base::error("usage", "one word too many; see 'mansard " + verb.app->get_name() + " --help'",
                                 verb.app->remaining().front()));
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
  std::signal(SIGINT, cli::on_interrupt);
  std::signal(SIGTERM, cli::on_interrupt);
  std::signal(SIGHUP, cli::on_interrupt);
  const struct Tidy {
    ~Tidy() { cli::remove_folders_left_empty(); }
  } tidy;
  try {
    return cli::printed(cli::run(argc, argv));
  } catch (const std::bad_alloc&) {
    return cli::give_up(base::error("memory", "out of memory; use a smaller piece of the mesh (--bbox)"));
  } catch (const std::exception& e) {
    return cli::give_up(base::error("bug", std::string(e.what()) + "; please report it with the command line used"));
  }
}
