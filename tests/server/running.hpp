// `mansard serve` in a separate process, and calls to it.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <httplib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/scratch.hpp"

namespace mansard::server {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

inline auto read(const fs::path& path) -> std::string {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

using Folder = test::Scratch;

struct Reply {
  int status = 0;
  std::string text;
  httplib::Headers headers;
  [[nodiscard]] auto json() const -> Json { return Json::parse(text); }
  [[nodiscard]] auto code() const -> std::string {
    const auto json = Json::parse(text, nullptr, false);
    return json.is_object() && json.contains("error") ? json["error"]["code"].get<std::string>() : "";
  }
};

/// A running server.
class Running {
 public:
  explicit Running(const fs::path& project, std::vector<std::string> more = {}) {
    std::vector<std::string> words{MANSARD_BINARY, "serve", project.string()};
    if (std::ranges::find(more, "--port") == more.end()) words.insert(words.end(), {"--port", "0"});
    words.insert(words.end(), more.begin(), more.end());
    std::array<int, 2> out{}, err{};
    if (::pipe(out.data()) != 0 || ::pipe(err.data()) != 0) std::abort();
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(err[1], STDERR_FILENO);
      for (const int end : {out[0], out[1], err[0], err[1]}) ::close(end);
      std::vector<char*> arguments;
      for (auto& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execv(arguments.front(), arguments.data());
      ::_exit(127);
    }
    ::close(out[1]);
    ::close(err[1]);
    out_ = out[0];
    err_ = err[0];
    link_ = line(out_);
    const auto colon = link_.rfind(':'), slash = link_.find('/', colon);
    if (link_.empty()) return;
    port_ = std::stoi(link_.substr(colon + 1, slash - colon - 1));
    token_ = link_.substr(link_.find("token=") + 6);
  }
  ~Running() {
    kill();
    ::close(out_);
    ::close(err_);
  }
  Running(const Running&) = delete;
  auto operator=(const Running&) -> Running& = delete;

  [[nodiscard]] auto link() const -> const std::string& { return link_; }
  [[nodiscard]] auto port() const -> int { return port_; }
  [[nodiscard]] auto token() const -> const std::string& { return token_; }
  [[nodiscard]] auto process() const -> pid_t { return child_; }
  /// Its output on stderr; waits until the process ends.
  [[nodiscard]] auto complaint() const -> std::string { return line(err_); }

  /// Sends the signal of Ctrl-C; returns the exit code.
  auto interrupt(int signal = SIGINT) -> int {
    ::kill(child_, signal);
    return wait();
  }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    wait();
  }
  auto wait() -> int {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  [[nodiscard]] auto headers() const -> httplib::Headers { return {{"Authorization", "Bearer " + token_}}; }
  [[nodiscard]] auto call(const std::string& method, const std::string& path, const std::string& body = {}) const
      -> Reply {
    return call(method, path, body, headers());
  }
  [[nodiscard]] auto call(const std::string& method, const std::string& path, const std::string& body,
                          httplib::Headers headers) const -> Reply {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(300);
    httplib::Request request;
    request.method = method;
    request.path = path;
    request.headers = std::move(headers);
    request.body = body;
    if (!body.empty() && !request.has_header("Content-Type")) request.set_header("Content-Type", "application/json");
    const auto result = client.send(request);
    return result ? Reply{result->status, result->body, result->headers} : Reply{};
  }
  [[nodiscard]] auto get(const std::string& path) const -> Reply { return call("GET", path); }
  [[nodiscard]] auto post(const std::string& path, const Json& body) const -> Reply {
    return call("POST", path, body.dump());
  }

  /// Waits until no job is queued or running.
  void settle() const {
    while (get("/api/status").json()["busy"].get<bool>()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  void open_hall() const {
    const std::string hall = std::string(MANSARD_DATA) + "/hall/";
    const auto reply =
        post("/api/project/inputs", {{"meshes", {hall + "mesh.off"}}, {"footprints", hall + "footprints.geojson"}});
    ASSERT_EQ(reply.status, 200) << reply.text;
    settle();
  }
  /// The id of a finished run.
  [[nodiscard]] auto reconstruct(const Json& request = Json::object()) const -> std::string {
    const auto reply = post("/api/runs", request);
    EXPECT_EQ(reply.status, 200) << reply.text;
    settle();
    return reply.json()["run"];
  }
  [[nodiscard]] auto buildings(const std::string& run) const -> Json {
    return get("/api/runs/" + run + "/buildings").json();
  }

 private:
  static auto line(int from) -> std::string {
    std::string text;
    char c = 0;
    while (::read(from, &c, 1) == 1 && c != '\n') text += c;
    return text;
  }
  pid_t child_ = -1;
  int out_ = -1, err_ = -1, port_ = 0;
  std::string link_, token_;
};

/// An edit that raises the cap and every roof point of a building's first part.
inline auto lift(const Json& building, double by, const std::string& what = "lift") -> Json {
  Json parts = Json::array();
  for (const auto& part : building["parts"]) parts.push_back({{"id", part["id"]}, {"plan", part["plan"]}});
  auto& plan = parts[0]["plan"];
  plan["cap"] = plan["cap"].get<double>() + by;
  for (auto& profile : plan["profiles"])
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i][1] = profile[i][1].get<double>() + by;
  return {
      {"what", what},
      {"changes", Json::array({{{"building", building["id"]}, {"revision", building["revision"]}, {"parts", parts}}})}};
}

/// A folder with a project in which the hall has been reconstructed: "run-1".
class WithHall : public testing::Test {
 protected:
  void SetUp() override {
    const Running server(project());
    server.open_hall();
    ASSERT_EQ(server.reconstruct(), "run-1");
    const auto runs = server.get("/api/project").json()["runs"];
    ASSERT_EQ(runs[0]["state"], "done") << runs.dump();
  }
  [[nodiscard]] auto project() const -> fs::path { return folder_ / "project"; }
  Folder folder_;
};

}  // namespace mansard::server
