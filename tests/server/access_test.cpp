// Access control over real sockets.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <atomic>
#include <string_view>
#include <thread>
#include <vector>

#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

/// Sends raw bytes; returns everything that is received until the server closes the connection.
auto raw(int port, const std::string& bytes) -> std::string {
  const int s = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(s, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) std::abort();
  (void)!::write(s, bytes.data(), bytes.size());
  std::string all;
  std::array<char, 4096> piece{};
  for (ssize_t n = 0; (n = ::read(s, piece.data(), piece.size())) > 0;)
    all.append(piece.data(), static_cast<std::size_t>(n));
  ::close(s);
  return all;
}

class Access : public testing::Test {
 protected:
  Folder folder_;
  Running server_{folder_ / "project"};
  [[nodiscard]] auto host() const -> std::string { return "127.0.0.1:" + std::to_string(server_.port()); }
};

TEST_F(Access, prints_a_link_and_accepts_only_its_token) {
  EXPECT_THAT(server_.link(), testing::MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/#token=[0-9a-f]{32}"));
  EXPECT_EQ(server_.get("/api/status").status, 200);
  for (const auto& headers : {httplib::Headers{}, httplib::Headers{{"Authorization", "Bearer " + std::string(32, '0')}},
                              httplib::Headers{{"Authorization", server_.token()}},
                              httplib::Headers{{"Cookie", "token=" + server_.token()}}}) {
    for (const auto* path :
         {"/api/status", "/api/project", "/api/events", "/api/openapi.json", "/api/nothing", "/api"}) {
      const auto reply = server_.call("GET", path, {}, headers);
      EXPECT_EQ(reply.status, 401) << path;
      EXPECT_EQ(reply.code(), "server-token") << path;
    }
    EXPECT_EQ(server_.call("POST", "/api/runs", "{}", headers).status, 401);
    EXPECT_EQ(server_.call("PUT", "/api/uploads/a.ply", "bytes", headers).status, 401);
    EXPECT_EQ(server_.call("DELETE", "/api/runs/run-1", "", headers).status, 401);
  }
  EXPECT_FALSE(fs::exists(folder_ / "project/inputs/a.ply"));
  EXPECT_EQ(server_.call("GET", "/api/status?token=" + server_.token(), {}, {}).status, 401) << "links are logged";
}

TEST_F(Access, refuses_other_hosts_and_pages_of_other_servers_even_with_the_token) {
  auto with = [&](const char* name, const std::string& value) {
    auto headers = server_.headers();
    headers.emplace(name, value);
    return server_.call("GET", "/api/status", {}, headers);
  };
  // tried: open the link that 'mansard serve' printed
  EXPECT_EQ(with("Host", "evil.example").code(), "server-host");
  EXPECT_EQ(with("Host", "evil.example:" + std::to_string(server_.port())).status, 403);
  EXPECT_EQ(with("Host", "localhost:" + std::to_string(server_.port())).status, 200);
  EXPECT_EQ(with("Origin", "http://evil.example").code(), "server-origin");
  EXPECT_EQ(with("Origin", "null").status, 403);
  EXPECT_EQ(with("Origin", "http://" + host()).status, 200);
  EXPECT_EQ(server_.call("GET", "/", {}, {{"Host", "evil.example"}}).status, 403) << "the page too";
  const auto bearer = "Authorization: Bearer " + server_.token() + "\r\nConnection: close\r\n";
  EXPECT_THAT(raw(server_.port(), "GET /api/status HTTP/1.1\r\n" + bearer + "\r\n"), HasSubstr("403")) << "no host";
  EXPECT_THAT(
      raw(server_.port(), "GET /api/status HTTP/1.1\r\nHost: " + host() + "\r\nHost: evil\r\n" + bearer + "\r\n"),
      HasSubstr("403"));
}

TEST_F(Access, sends_headers_that_keep_other_pages_from_reading_or_framing_it) {
  for (const auto* path : {"/", "/api/status"}) {
    const auto reply = server_.get(path);
    EXPECT_EQ(reply.status, 200);
    const auto header = [&](const char* name) {
      const auto at = reply.headers.find(name);
      return at == reply.headers.end() ? std::string() : at->second;
    };
    EXPECT_THAT(header("Content-Security-Policy"), HasSubstr("default-src 'self'"));
    EXPECT_THAT(header("Content-Security-Policy"), testing::Not(HasSubstr("unsafe-eval")));
    EXPECT_EQ(header("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(header("Referrer-Policy"), "no-referrer");
    EXPECT_NE(header("Cache-Control"), "");
    for (const auto& [name, value] : reply.headers)
      EXPECT_THAT(name, testing::Not(testing::StartsWith("Access-Control")));
  }
  EXPECT_EQ(server_.call("OPTIONS", "/api/status").status, 405);
}

TEST_F(Access, refuses_names_that_leave_their_folder) {
  const std::string secret = "not yours";
  write(folder_ / "secret.txt", secret);
  for (const std::string name : {"..", "%2e%2e", "..%2f..%2fsecret.txt", "%2e%2e%2fsecret.txt", ".hidden", "a%00b",
                                 "a%2fb", "a%5cb", "%20", "a%0ab", "%20a", "a%20", "a%7f", "a%ff"}) {
    const auto put = server_.call("PUT", "/api/uploads/" + name, "bytes");
    EXPECT_GE(put.status, 400) << name;
    const auto got = server_.get("/api/runs/run-1/export/" + name);
    EXPECT_GE(got.status, 400) << name;
    EXPECT_GE(server_.get("/api/scene/tiles/" + name).status, 400) << name;
    EXPECT_GE(server_.get("/api/runs/" + name + "/report").status, 400) << name;
  }
  EXPECT_EQ(server_.call("PUT", "/api/uploads/" + std::string(129, 'a'), "bytes").code(), "server-upload");
  for (const std::string path : {"/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/assets/../../secret.txt",
                                 "//etc/passwd", "/assets/%2e%2e/%2e%2e/secret.txt"}) {
    const auto answer =
        raw(server_.port(), "GET " + path + " HTTP/1.1\r\nHost: " + host() + "\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 404")) << path;
    EXPECT_THAT(answer, testing::Not(HasSubstr(secret))) << path;
  }
  EXPECT_EQ(read(folder_ / "secret.txt"), secret);
  EXPECT_TRUE(fs::is_empty(folder_ / "project/inputs"));
}

TEST_F(Access, refuses_large_bodies_and_keeps_serving) {
  const std::string large(17 << 20, ' ');
  const auto reply = server_.call("POST", "/api/runs", large);
  EXPECT_EQ(reply.status, 413);
  EXPECT_EQ(reply.code(), "server-large");
  EXPECT_GE(server_.get("/" + std::string(5000, 'a')).status, 400);
  EXPECT_EQ(server_.get("/api/status").status, 200);
}

TEST_F(Access, refuses_uploads_above_the_limit_and_deletes_them) {
  const Running small(folder_ / "small", {"--upload-limit", "1"});
  const auto reply = small.call("PUT", "/api/uploads/mesh.ply", std::string(2 << 20, 'x'));
  EXPECT_EQ(reply.status, 413) << reply.text;
  EXPECT_TRUE(fs::is_empty(folder_ / "small/inputs"));
  EXPECT_EQ(small.call("PUT", "/api/uploads/mesh.ply", std::string(1 << 20, 'x')).status, 200);
  EXPECT_EQ(fs::file_size(folder_ / "small/inputs/mesh.ply"), 1U << 20);
}

TEST_F(Access, deletes_incomplete_uploads) {
  {
    const int s = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(server_.port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(::connect(s, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    const auto head = "PUT /api/uploads/mesh.ply HTTP/1.1\r\nHost: " + host() + "\r\nAuthorization: Bearer " +
                      server_.token() + "\r\nContent-Length: 1000000\r\n\r\nonly this";
    ASSERT_GT(::write(s, head.data(), head.size()), 0);
    ::close(s);
  }
  for (int i = 0; i < 200 && !fs::is_empty(folder_ / "project/inputs"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(server_.get("/api/status").status, 200);
  EXPECT_FALSE(fs::exists(folder_ / "project/inputs/mesh.ply"));
}

TEST_F(Access, does_not_parse_the_rest_of_a_refused_request_as_another_one) {
  const auto inner = "GET /api/status HTTP/1.1\r\nHost: " + host() + "\r\nAuthorization: Bearer " + server_.token() +
                     "\r\nConnection: close\r\n\r\n";
  for (const std::string& head :
       {"GET /api/status HTTP/1.1\r\nHost: " + host() + "\r\nContent-Length: " + std::to_string(inner.size()) +
            "\r\n\r\n",
        "POST /api/runs HTTP/1.1\r\nHost: " + host() + "\r\nTransfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\n",
        "POST /api/runs HTTP/1.1\r\nHost: " + host() +
            "\r\nContent-Type: multipart/form-data; boundary=b\r\nContent-Length: " + std::to_string(inner.size()) +
            "\r\n\r\n"}) {
    const auto all = raw(server_.port(), head + inner);
    EXPECT_THAT(all, testing::StartsWith("HTTP/1.1 4")) << head;
    EXPECT_THAT(all, testing::Not(HasSubstr("HTTP/1.1 200"))) << head;
  }
}

TEST_F(Access, refuses_invalid_http_and_keeps_serving) {
  for (const std::string bytes : {"\r\n\r\n", "GARBAGE\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GET\r\n\r\n"})
    (void)raw(server_.port(), bytes);
  EXPECT_EQ(server_.get("/api/status").status, 200);
}

TEST_F(Access, reports_the_place_in_malformed_json_and_the_name_of_unknown_things) {
  const auto reply = server_.call("POST", "/api/runs", "{\"label\":");
  EXPECT_EQ(reply.status, 400);
  EXPECT_EQ(reply.code(), "server-body");
  EXPECT_THAT(reply.text, HasSubstr("at byte"));
  EXPECT_EQ(server_.get("/api/scene").code(), "server-no-scene");
  EXPECT_EQ(server_.get("/api/scene").status, 404);
  EXPECT_EQ(server_.post("/api/runs", Json::object()).code(), "server-no-scene");
  for (const auto* path : {"/report", "/buildings", "/layers", "/error", "/error/block-1", "/export/model.obj",
                           "/section?building=a&part=b&ring=0&edge=0&share=0.5"}) {
    const auto gone = server_.get(std::string("/api/runs/run-9") + path);
    EXPECT_EQ(gone.status, 404) << path;
    EXPECT_EQ(gone.code(), "server-unknown") << path;
  }
  EXPECT_EQ(server_.call("DELETE", "/api/jobs/job-9").code(), "server-unknown");
  EXPECT_EQ(server_.call("DELETE", "/api/runs/run-9").code(), "server-unknown");
  EXPECT_EQ(server_.post("/api/project/inputs", {{"meshes", {"/no/such"}}, {"footprints", "/none"}}).code(),
            "file-missing");
  EXPECT_EQ(
      server_.post("/api/project/inputs", {{"meshes", {"/"}}, {"footprints", "/"}, {"reading", {{"ingest.csr", "x"}}}})
          .code(),
      "option-unknown");
}

TEST_F(Access, accepts_twelve_listening_pages_and_refuses_more) {
  std::vector<std::thread> pages;
  std::atomic<int> pings{0};
  std::atomic<bool> enough{false};
  std::atomic<int> refused{0};
  for (int i = 0; i < 13; ++i)
    pages.emplace_back([&] {
      httplib::Client client("127.0.0.1", server_.port());
      client.set_read_timeout(30);
      bool counted = false;
      const auto result = client.Get("/api/events", server_.headers(), [&](const char*, std::size_t) {
        if (!counted) ++pings;
        counted = true;
        return !enough;
      });
      if (result && result->status == 503) ++refused;
    });
  const auto upload = [&] { return server_.call("PATCH", "/api/runs/x", "{}").status; };
  for (int i = 0; i < 3000 && (pings < 12 || refused < 1); ++i) {
    EXPECT_EQ(upload(), 400);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(refused, 1);
  EXPECT_GE(pings, 12);
  enough = true;
  EXPECT_EQ(server_.get("/api/status").status, 200) << "other requests are still answered";
  EXPECT_EQ(server_.interrupt(), 0) << "the server ends while pages are listening";
  for (auto& page : pages) page.join();
}

TEST(Serve, ends_cleanly_on_a_signal) {
  const Folder folder;
  for (const int signal : {SIGINT, SIGTERM}) {
    Running server(folder / "project");
    EXPECT_EQ(server.get("/api/status").status, 200);
    EXPECT_EQ(server.interrupt(signal), 0);
  }
}

TEST(Serve, reports_why_it_cannot_start) {
  const Folder folder;
  Running first(folder / "project");
  Running second(folder / "project");
  EXPECT_THAT(second.complaint(), HasSubstr("error[server-locked]"));
  EXPECT_EQ(second.wait(), 2);
  Running taken(folder / "other", {"--port", std::to_string(first.port())});
  EXPECT_THAT(taken.complaint(), HasSubstr("error[server-port]"));
  EXPECT_EQ(taken.wait(), 2);
  {
    // tried: cannot listen: the port is in use
    const Running free(folder / "other", {"--port", "0"});
    EXPECT_EQ(free.get("/api/status").status, 200);
  }
  // tried: the project is open in another 'mansard serve'; use its page, or stop it first
  EXPECT_EQ(first.get("/api/status").status, 200);
  EXPECT_EQ(first.interrupt(), 0);
  {
    const Running next(folder / "project");
    EXPECT_EQ(next.get("/api/status").status, 200);
  }
  write(folder / "file", "");
  Running file(folder / "file");
  EXPECT_THAT(file.complaint(), HasSubstr("error[server-folder]"));
  EXPECT_EQ(file.wait(), 2);
  Running sample(folder / "third", {"--sample", (folder / "nowhere").string()});
  EXPECT_THAT(sample.complaint(), HasSubstr("error[server-sample]"));
  EXPECT_EQ(sample.wait(), 2);
}

TEST(Serve, warns_when_other_machines_can_reach_it) {
  const Folder folder;
  Running open(folder / "project", {"--address", "0.0.0.0"});
  EXPECT_THAT(open.complaint(), HasSubstr("other machines"));
  EXPECT_THAT(open.link(), testing::StartsWith("http://127.0.0.1:"));  // no browser opens 0.0.0.0
  EXPECT_EQ(open.get("/api/status").status, 200);
}

/// Connections on which nothing, or half a request, arrives.
class HalfOpen {
 public:
  HalfOpen(int port, std::size_t count, const std::string& begun) {
    for (std::size_t i = 0; i < count; ++i) {
      const int s = ::socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_port = htons(static_cast<std::uint16_t>(port));
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      EXPECT_EQ(::connect(s, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
      if (!begun.empty()) {
        EXPECT_GT(::write(s, begun.data(), begun.size()), 0);
      }
      sockets_.push_back(s);
    }
  }
  HalfOpen(const HalfOpen&) = delete;
  auto operator=(const HalfOpen&) -> HalfOpen& = delete;
  ~HalfOpen() {
    for (const int s : sockets_) ::close(s);
  }

 private:
  std::vector<int> sockets_;
};

/// Connections that send one byte of a header after the other, and never end it.
class Trickling {
 public:
  Trickling(int port, std::size_t count) : port_(port) {
    sender_ = std::thread([this, count] {
      std::vector<int> sockets;
      while (!enough_) {
        // A few at a time: the kernel drops what the server has not accepted yet.
        for (int i = 0; i < 4 && sockets.size() < count; ++i) sockets.push_back(opened());
        all_ = sockets.size() == count;
        for (const int s : sockets) {
          if (::send(s, "X", 1, MSG_NOSIGNAL | MSG_DONTWAIT) == 1) continue;
          ++ended_;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
      }
      for (const int s : sockets) ::close(s);
    });
  }
  Trickling(const Trickling&) = delete;
  auto operator=(const Trickling&) -> Trickling& = delete;
  ~Trickling() {
    enough_ = true;
    sender_.join();
  }
  /// Waits until all are open.
  void wait_for_all() const {
    while (!all_) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  /// Waits until the server has ended one.
  void wait_for_an_end() const {
    while (ended_ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

 private:
  [[nodiscard]] auto opened() const -> int {
    const int s = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port_));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(s, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    constexpr std::string_view begun = "GET /api/status HTTP/1.1\r\nHost: ";
    EXPECT_GT(::write(s, begun.data(), begun.size()), 0);
    return s;
  }
  int port_;
  std::atomic<bool> enough_ = false, all_ = false;
  std::atomic<int> ended_ = 0;
  std::thread sender_;
};

TEST_F(Access, more_half_open_connections_than_threads_do_not_keep_others_waiting) {
  const Trickling slow(server_.port(), 400);
  slow.wait_for_all();
  httplib::Client client("127.0.0.1", server_.port());
  client.set_read_timeout(5);
  const auto answer = client.Get("/api/status", server_.headers());
  ASSERT_TRUE(answer) << "no answer while connections of the same address send byte after byte";
  EXPECT_EQ(answer->status, 200);
}

TEST_F(Access, a_request_that_comes_byte_by_byte_is_ended) {
  const Trickling slow(server_.port(), 1);
  slow.wait_for_an_end();  // without a limit of the whole request this never returns
  EXPECT_EQ(server_.get("/api/status").status, 200);
}

TEST_F(Access, half_open_connections_do_not_keep_others_waiting) {
  const HalfOpen begun(server_.port(), 100, "GET /api/status HTTP/1.1\r\n"), silent(server_.port(), 100, "");
  // Threads that wait for the rest of a request are free after the time limit. An answer before that needs another.
  httplib::Client client("127.0.0.1", server_.port());
  client.set_read_timeout(3);
  const auto answer = client.Get("/api/status", server_.headers());
  ASSERT_TRUE(answer) << "no answer before the time limit of the half-open connections";
  EXPECT_EQ(answer->status, 200);
}

}  // namespace
}  // namespace mansard::server
