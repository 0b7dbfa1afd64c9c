// The only file that uses the HTTP library: access checks, bodies in, answers out. The handlers are in routes.cpp.
#include "apps/server/server.hpp"

#include <httplib.h>
#include <malloc.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "apps/server/connections.hpp"
#include "apps/server/guard.hpp"
#include "apps/server/json.hpp"
#include "apps/server/routes.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

using namespace std::chrono_literals;

/// Each listener may occupy a thread, and so does a connection on which a request has begun to arrive, until the time
/// limit ends it: forty of those a second leave some threads to answer others. An idle thread costs its stack's pages.
constexpr std::size_t threads = 256;
/// Seconds for the next bytes of a request to arrive. Connections on which nothing arrives are left to the kernel for
/// as long, and occupy no thread.
constexpr int arrival_limit = 5;
/// Maximum length of a path in characters; the library's regular expressions use stack for each of them.
constexpr std::size_t maximum_path = 1024;
/// Bytes of a refused body that are read before the answer, so that a client that is still sending receives it.
constexpr std::uint64_t maximum_skipped = std::uint64_t{64} << 20;
constexpr auto between_pings = 10s;
constexpr auto between_looks = 500ms;
/// A body must come faster than this many bytes a second, counted from its beginning and after some grace: any network
/// is faster, and a thread waits for it.
constexpr std::uint64_t slowest = 1000;
constexpr std::chrono::seconds grace{10};

constexpr const char* content_security_policy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr auto answered = httplib::Server::HandlerResponse::Handled;
constexpr auto not_handled = httplib::Server::HandlerResponse::Unhandled;

auto header(const httplib::Request& request, const char* name) -> std::string { return request.get_header_value(name); }

auto has_body(const httplib::Request& request) -> bool {
  const auto length = header(request, "Content-Length");
  return request.has_header("Transfer-Encoding") || (!length.empty() && length != "0");
}

void put(const Answer& answer, httplib::Response& response) {
  response.status = answer.status;
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  if (!answer.headers.contains("Cache-Control")) response.set_header("Cache-Control", "no-store");
  if (answer.status != 304) response.set_content(answer.body, answer.type);
}

/// Answers and closes the connection, so that the rest of the request is not parsed as the next one. The library closes
/// it when a content provider returns false, even after the last byte.
void put_and_close(const Answer& answer, httplib::Response& response) {
  put(answer, response);
  response.body.clear();
  response.headers.erase("Content-Type");
  response.set_header("Connection", "close");
  response.set_content_provider(answer.body.size(), answer.type,
                                [body = answer.body](std::size_t from, std::size_t length, httplib::DataSink& sink) {
                                  sink.write(body.data() + from, length);
                                  return false;
                                });
}

/// Reads a body piece by piece. Once a piece is refused, at most `maximum_skipped` further bytes are read.
class Body {
 public:
  Body(const httplib::Request& request, const httplib::ContentReader& reader) : request_(request), reader_(reader) {}

  /// False if `take` refused a piece or the connection was lost.
  auto read(const std::function<bool(std::string_view)>& take) -> bool {
    if (!has_body(request_)) return true;  // without a length the library would read until the client disconnects
    std::uint64_t unwanted = 0, all = 0;
    bool wanted = true;
    const auto began = std::chrono::steady_clock::now();
    const bool whole = reader_([&](const char* data, std::size_t length) {
      all += length;
      const auto passed = std::chrono::steady_clock::now() - began;
      if (passed > grace && all < slowest * static_cast<std::uint64_t>(passed / 1s)) return false;
      if (wanted) wanted = take({data, length});
      if (!wanted) unwanted += length;
      return unwanted <= maximum_skipped;
    });
    rest_ = !whole;
    return whole && wanted;
  }
  void skip() {
    (void)read([](std::string_view) { return false; });
  }
  /// Whether a part was left unread.
  [[nodiscard]] auto rest() const -> bool { return rest_; }

 private:
  const httplib::Request& request_;
  const httplib::ContentReader& reader_;
  bool rest_ = false;
};

/// A pool that reports every connection that it is given.
class Threads : public httplib::TaskQueue {
 public:
  Threads(std::size_t count, Connections& connections) : pool_(count), connections_(connections) {}
  void enqueue(std::function<void()> work) override {
    connections_.accepted();
    pool_.enqueue(std::move(work));
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  httplib::ThreadPool pool_;
  Connections& connections_;
};

auto too_large(std::uint64_t limit) -> base::Diagnostic {
  return base::error("server-large", "the body is larger than the limit of " + std::to_string(limit >> 20) + " MB");
}

class Web {
 public:
  Web(const Options& options, Workspace& workspace) : options_(options), workspace_(workspace) {
    http_.new_task_queue = [this] { return new Threads(threads, connections_); };
    // Not SO_REUSEPORT, the library's default: another program could listen on the same port and receive calls.
    http_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      ::setsockopt(socket, IPPROTO_TCP, TCP_DEFER_ACCEPT, &arrival_limit, sizeof arrival_limit);
    });
    http_.set_tcp_nodelay(true);
    http_.set_read_timeout(arrival_limit);
    http_.set_keep_alive_max_count(100'000);
    // Seconds. Browsers reuse connections, and a busy one may send on a connection that was just closed; but each idle
    // connection occupies a thread.
    http_.set_keep_alive_timeout(Connections::idle_limit.count());
    http_.set_default_headers({{"Content-Security-Policy", content_security_policy},
                               {"X-Content-Type-Options", "nosniff"},
                               {"X-Frame-Options", "DENY"},
                               {"Referrer-Policy", "no-referrer"},
                               {"Cross-Origin-Opener-Policy", "same-origin"},
                               {"Cross-Origin-Resource-Policy", "same-origin"}});
    http_.set_pre_routing_handler([this](const auto& request, auto& response) {
      connections_.arrived(request.remote_addr, request.remote_port);
      return receive(request, response);
    });
    http_.set_logger([this](const auto& request, const auto&) {  // called when an answer has been sent
      connections_.answered(request.remote_addr, request.remote_port);
    });
    const auto with_body = [this](const auto& request, auto& response, const auto& reader) {
      receive(request, response, reader);
    };
    for (auto add : {static_cast<AddHandler>(&httplib::Server::Post), static_cast<AddHandler>(&httplib::Server::Put),
                     static_cast<AddHandler>(&httplib::Server::Patch)})
      (http_.*add)(R"([\s\S]*)", with_body);
    http_.set_exception_handler([](const auto&, auto& response, std::exception_ptr) {
      put_and_close(refusal(base::error("bug", "the request failed unexpectedly; please report it")), response);
    });
    http_.set_error_handler(httplib::Server::HandlerWithResponse([](const auto&, httplib::Response& response) {
      if (!response.body.empty() || response.content_length_ != 0) return not_handled;
      const int status = response.status;  // refused by the library: not valid HTTP
      put_and_close(refusal(base::error("server-body", "the request is not valid HTTP")), response);
      response.status = status;
      return answered;
    }));
  }
  Web(const Web&) = delete;
  auto operator=(const Web&) -> Web& = delete;
  ~Web() { stop(); }

  /// Starts to listen; returns the link. Fails with "server-port", "server-random".
  auto start() -> base::Result<std::string> {
    const int port = options_.port == 0                                    ? http_.bind_to_any_port(options_.address)
                     : http_.bind_to_port(options_.address, options_.port) ? options_.port
                                                                           : -1;
    if (port < 0)
      return base::error("server-port",
                         "cannot listen: the port is in use, or the address is not one of this machine; choose another "
                         "port with --port (0: any free port)",
                         options_.address + ":" + std::to_string(options_.port));
    auto token = new_token();
    if (!token) return token.error();
    guard_ = std::make_unique<Guard>(options_.address, port, *token);
    connections_.listen(port);
    thread_ = std::thread([this] { http_.listen_after_bind(); });
    while (!http_.is_running()) std::this_thread::sleep_for(1ms);  // an earlier stop() would have no effect
    // "Every address" is none that a browser can open: on this machine it is the loopback's, also from outside a
    // container that passes the port on.
    const std::string address = options_.address == "0.0.0.0" ? "127.0.0.1"
                                : options_.address == "::"    ? "::1"
                                                              : options_.address;
    const auto host = address.find(':') == std::string::npos ? address : "[" + address + "]";
    return "http://" + host + ":" + std::to_string(port) + "/#token=" + *token;
  }

  /// To be called now and then.
  void tend() { connections_.end_slow(); }

  void stop() {
    if (!thread_.joinable()) return;
    http_.stop();
    workspace_.stop();  // ends the event streams
    connections_.end_reading();
    thread_.join();
  }

 private:
  using AddHandler = httplib::Server& (httplib::Server::*)(const std::string&,
                                                           httplib::Server::HandlerWithContentReader);

  auto call_of(const httplib::Request& request) const -> Call {
    Call call{request.method, request.path, {}, {}, header(request, "X-Client").substr(0, 64), {}};
    if (call.method == "HEAD") call.method = "GET";  // the library omits the body
    for (const auto& [name, value] : request.params) call.query.emplace(name, value);
    return call;
  }

  auto check(const httplib::Request& request) const -> base::Result<void> {
    std::optional<std::string> origin;
    if (request.has_header("Origin")) origin = header(request, "Origin");
    // With two headers, another one than the one checked here could be used.
    if (request.get_header_value_count("Host") != 1 || request.get_header_value_count("Origin") > 1)
      return base::error("server-host", "expected exactly one header Host and at most one Origin");
    return guard_->check(header(request, "Host"), origin);
  }

  static auto is_api(const std::string& path) -> bool { return path == "/api" || path.starts_with("/api/"); }

  /// Checks the access, then finds the route, and sets `captured` of the call.
  auto route_of(const httplib::Request& request, Call& call) const -> base::Result<const Route*> {
    if (auto checked = check(request); !checked) return checked.error();
    if (request.path.size() > maximum_path)
      return base::error("server-path", "the path is longer than " + std::to_string(maximum_path) + " characters");
    if (is_api(request.path))
      if (auto checked = guard_->check_token(header(request, "Authorization")); !checked) return checked.error();
    return find_route(call);
  }

  /// Handles every request; those with a body are passed on to the other receive().
  auto receive(const httplib::Request& request, httplib::Response& response) -> httplib::Server::HandlerResponse {
    // On one machine compressing costs more than sending, and ranges are not needed. The library's own request object
    // is not const.
    auto& mine = const_cast<httplib::Request&>(request);  // NOLINT
    mine.headers.erase("Accept-Encoding");
    mine.ranges.clear();
    const bool sends = request.method == "POST" || request.method == "PUT" || request.method == "PATCH";
    if (sends && request.path.size() <= maximum_path && !request.is_multipart_form_data() &&
        !(request.has_header("Content-Length") && request.has_header("Transfer-Encoding")))
      return not_handled;
    auto call = call_of(request);
    if (!sends && !has_body(request) && !is_api(request.path) && call.method == "GET") {
      const auto checked = check(request);
      put(checked ? page(request.path, header(request, "If-None-Match")) : refusal(checked.error()), response);
      return answered;
    }
    const auto route = route_of(request, call);
    if (sends || has_body(request)) {
      put_and_close(
          refusal(route ? base::error("server-body", "this call does not accept such a body") : route.error()),
          response);
    } else if (!route) {
      put(refusal(route.error()), response);
    } else if ((*route)->gives == Gives::events) {
      stream(response);
    } else {
      put(answer(workspace_, **route, call), response);
    }
    return answered;
  }

  void receive(const httplib::Request& request, httplib::Response& response, const httplib::ContentReader& reader) {
    Body body(request, reader);
    auto call = call_of(request);
    const auto route = route_of(request, call);
    Answer out;
    if (!route) {
      body.skip();
      out = refusal(route.error());
    } else if ((*route)->sends == Sends::file) {
      std::optional<std::uint64_t> length;
      if (const auto given = base::to_integer(header(request, "Content-Length")); given && *given >= 0)
        length = static_cast<std::uint64_t>(*given);
      out = upload(call, length, body);
    } else {
      bool fits = true;
      const bool whole = body.read([&](std::string_view piece) {
        fits = call.body.size() + piece.size() <= json_limit;
        if (fits) call.body += piece;
        return fits;
      });
      out = !fits    ? refusal(too_large(json_limit))
            : !whole ? refusal(base::error("server-body", "the connection ended before the whole body was received"))
                     : answer(workspace_, **route, call);
    }
    body.rest() ? put_and_close(out, response) : put(out, response);
  }

  auto upload(const Call& call, const std::optional<std::uint64_t>& length, Body& body) const -> Answer {
    const auto folder = call.query.find("folder");
    const auto path = workspace_.upload_path(
        call.captured.at("name"), folder == call.query.end() ? std::nullopt : std::optional(folder->second), length);
    auto file = path ? Arriving::open(*path) : base::Result<Arriving>(path.error());
    if (!file) {
      body.skip();
      return refusal(file.error());
    }
    std::optional<base::Diagnostic> why;
    const bool whole = body.read([&](std::string_view piece) {
      if (file->size() + piece.size() > options_.upload_limit) why = too_large(options_.upload_limit);
      else if (auto added = file->add(piece); !added) why = added.error();
      return !why;
    });
    if (why) return refusal(*why);
    if (!whole) return refusal(base::error("server-body", "the connection ended before the whole file was received"));
    if (auto finished = file->finish_new(); !finished) return refusal(finished.error());
    return {200, "application/json", text_of({{"path", path->string()}}), {}};
  }

  void stream(httplib::Response& response) {
    std::shared_ptr<Listener> listener = workspace_.listen();
    if (!listener) {
      put(refusal(base::error("server-listeners", "too many pages are connected to this server (at most " +
                                                      std::to_string(Events::most_listeners) + "); close one")),
          response);
      return;
    }
    response.status = 200;
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider("text/event-stream", [listener](std::size_t, httplib::DataSink& sink) {
      const auto text = listener->next(between_pings);
      if (!text) return false;
      return sink.write(text->data(), text->size());
    });
  }

  const Options& options_;
  Workspace& workspace_;
  httplib::Server http_;
  std::unique_ptr<Guard> guard_;
  Connections connections_;
  std::thread thread_;
};

}  // namespace

auto serve(const Options& options, const base::Cancel& cancel,
           const std::function<void(const std::string& link)>& ready) -> base::Result<void> {
  // Otherwise the C library raises this to what was freed last, up to 32 MB, and large arrays of a reading leave holes
  // of that size between what stays.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  auto project = Project::open(options.project);
  if (!project) return project.error();
  auto workspace = Workspace::open(std::move(*project), options.sample);
  if (workspace) (*workspace)->set_basemap(options.basemap);
  if (workspace) (*workspace)->set_reviewer(options.reviewer);
  if (!workspace) return workspace.error();
  Web web(options, **workspace);
  const auto link = web.start();
  if (!link) return link.error();
  ready(*link);
  auto tended = std::chrono::steady_clock::now();
  while (!cancel.requested()) {
    std::this_thread::sleep_for(20ms);
    if (const auto now = std::chrono::steady_clock::now(); now - tended > between_looks) {
      web.tend();
      tended = now;
    }
  }
  web.stop();
  return {};
}

}  // namespace mansard::server
