// `mansard serve [PROJECT]`: the workbench in a browser.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/scan.hpp"
#include "apps/cli/verbs.hpp"
#include "apps/server/guard.hpp"
#include "apps/server/server.hpp"
#include "mansard/formats/ground_tiles.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::cli {
namespace {

namespace fs = std::filesystem;

struct ServeRequest {
  server::Options options;
  std::string project = "mansard-project", sample, basemap;
  std::uint64_t upload_limit = 4096;  // MB
  std::size_t jobs = 0;
  bool open = false, quiet = false;
};

/// A file that redirects to the link. On a command line, as `xdg-open LINK`, everybody on the machine could read the
/// token.
class Opener {
 public:
  Opener(const fs::path& project, const std::string& link) : path_(fs::absolute(project) / "open.html") {
    ::unlink(path_.c_str());
    const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return;
    const auto text = "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url=" + link + "\">\n";
    there_ = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(file);
  }
  Opener(const Opener&) = delete;
  auto operator=(const Opener&) -> Opener& = delete;
  ~Opener() { ::unlink(path_.c_str()); }

  /// False: no browser was found.
  [[nodiscard]] auto open() const -> bool {
    if (!there_) return false;
    const auto child = ::fork();
    if (child < 0) return false;
    if (child == 0) {
      const int nowhere = ::open("/dev/null", O_RDWR);
      for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
      ::execlp("xdg-open", "xdg-open", path_.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    int status = 0;
    return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  fs::path path_;
  bool there_ = false;
};

/// The sample that comes with the program: beside an installed one, or in the repository that it was built in.
auto own_sample() -> fs::path {
  std::error_code status;
  const auto folder = fs::read_symlink("/proc/self/exe", status).parent_path();
  const auto installed = folder / "../share/mansard/data/delft";
  return (fs::is_directory(installed, status) ? installed : folder / "../../../data/delft").lexically_normal();
}

/// The name that the user has logged in with; empty if nothing says it, as in some containers.
auto user_name() -> std::string {
  const char* user = std::getenv("USER");  // NOLINT: nothing changes the environment
  return user == nullptr ? "" : user;
}

auto serve(const ServeRequest& request, const base::Cancel& cancel) -> int {
  auto options = request.options;
  options.project = request.project;
  options.sample = request.sample.empty() ? own_sample() : fs::path(request.sample);
  options.upload_limit = request.upload_limit << 20;
  std::error_code status;
  if (!request.sample.empty() && !fs::is_directory(options.sample, status))
    return give_up(base::error("server-sample", "the folder does not exist; check --sample", request.sample));
  if (formats::is_ground_tiles(request.basemap)) {
    const auto pattern = formats::ground_tiles_pattern(request.basemap);
    if (!pattern) return give_up(pattern.errors());
    options.basemap.tiles = *pattern;
  } else if (!request.basemap.empty()) {
    if (auto there = formats::check_input(request.basemap); !there) return give_up(there.error());
    options.basemap.file = fs::absolute(request.basemap);
  }
  if (options.reviewer.empty()) options.reviewer = user_name();
  base::limit_threads(request.jobs);
  if (!server::is_loopback(options.address))
    std::fprintf(
        stderr,
        "mansard: %s is reachable from other machines and the connection is not encrypted: anyone who sees the link "
        "or the traffic has full access\n",
        options.address.c_str());
  std::unique_ptr<Opener> opener;
  const auto served = server::serve(options, cancel, [&](const std::string& link) {
    std::printf("%s\n", link.c_str());
    std::fflush(stdout);
    if (!request.open) return;
    opener = std::make_unique<Opener>(options.project, link);
    if (!opener->open() && !request.quiet)
      std::fprintf(stderr, "mansard: no browser could be started; open the link in one\n");
  });
  return served ? all_done : give_up(served.errors());
}

}  // namespace

auto serve_verb(CLI::App& app, const base::Cancel& cancel) -> Verb {
  auto* verb = add_verb(app, "serve");
  auto request = std::make_shared<ServeRequest>();
  verb->add_option("PROJECT", request->project, "Folder of the project; created if it is missing")
      ->type_name("PROJECT");
  verb->add_option("--port", request->options.port, "Port to listen on; 0 for any free port")
      ->check(CLI::Range(0, 65535));
  verb->add_option("--address", request->options.address, "Address of this machine to listen on")->type_name("ADDRESS");
  verb->add_flag("--open", request->open, "Open the page in a browser");
  verb->add_option("--sample", request->sample,
                   "Folder with meshes and a file 'footprints', offered to empty projects as a sample")
      ->type_name("DIR");
  auto* basemap =
      verb->add_option("--basemap", request->basemap,
                       "Picture of the ground, offered as a layer under the models: a raster that says where "
                       "it is; a folder of tiles; or tiles on a server, as https://…/{z}/{x}/{y}.png, which "
                       "are fetched when the layer is shown")
          ->type_name("FILE|FOLDER|URL");
  verb->add_option("--basemap-attribution", request->options.basemap.attribution,
                   "Text to show with the basemap, as its licence asks for: '© OpenStreetMap contributors'")
      ->type_name("TEXT")
      ->needs(basemap);
  verb->add_option("--reviewer", request->options.reviewer,
                   "Who decides about models on the page, written beside each decision; without it, the name of the "
                   "user")
      ->type_name("NAME");
  verb->add_option("--upload-limit", request->upload_limit, "Maximum size of an uploaded file, in MB")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 24));
  add_jobs(*verb, request->jobs);
  verb->add_flag("-q,--quiet", request->quiet, "Print the link only");
  return {verb, [request, &cancel] { return serve(*request, cancel); }};
}

}  // namespace mansard::cli
