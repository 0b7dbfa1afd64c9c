// The only file that knows the HTTP library. It checks who calls, brings bodies in and answers out; what the calls mean
// is in routes.cpp.
#include "apps/server/server.hpp"

#include <httplib.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "apps/server/guard.hpp"
#include "apps/server/json.hpp"
#include "apps/server/routes.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/text.hpp"

namespace mansard::server {
namespace {

using namespace std::chrono_literals;

/// As many listeners as there may be hold a thread each; the rest answers.
constexpr std::size_t threads = 2 * Events::most_listeners;
/// Characters; nothing here has a longer path, and the library's way of matching takes stack for every one.
constexpr std::size_t longest_path = 1024;
/// Bytes of a refused body that are read before the answer, so that a client which is still sending gets it.
constexpr std::uint64_t patience = std::uint64_t{64} << 20;
constexpr auto between_pings = 10s;

constexpr const char* content_security_policy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr auto answered = httplib::Server::HandlerResponse::Handled;
constexpr auto goes_on = httplib::Server::HandlerResponse::Unhandled;

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

/// Answers and closes the connection: what is left of the request must not be taken for the next one. The library does
/// so when the provider of an answer's content gives up, even after the last byte.
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

/// The body piece by piece, without more of it than `patience` beyond what anybody wants.
class Body {
 public:
  Body(const httplib::Request& request, const httplib::ContentReader& reader) : request_(request), reader_(reader) {}

  /// False: `take` refused a piece, or the connection broke.
  auto read(const std::function<bool(std::string_view)>& take) -> bool {
    if (!has_body(request_)) return true;  // without a length the library would read until the client hangs up
    std::uint64_t unwanted = 0;
    bool wanted = true;
    const bool whole = reader_([&](const char* data, std::size_t length) {
      if (wanted) wanted = take({data, length});
      if (!wanted) unwanted += length;
      return unwanted <= patience;
    });
    rest_ = !whole;
    return whole && wanted;
  }
  void skip() {
    (void)read([](std::string_view) { return false; });
  }
  /// Whether some of it was left unread.
  [[nodiscard]] auto rest() const -> bool { return rest_; }

 private:
  const httplib::Request& request_;
  const httplib::ContentReader& reader_;
  bool rest_ = false;
};

/// Connections that wait for a next request end at once; answers under way are still sent. The library keeps its
/// sockets to itself: they are known by the port they came in by.
void hear_nothing_more(int port) {
  std::error_code status;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", status)) {
    const int file = static_cast<int>(base::to_integer(entry.path().filename().string()).value_or(-1));
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (::getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) continue;                    // NOLINT
    const auto in = address.ss_family == AF_INET ? reinterpret_cast<const sockaddr_in*>(&address)->sin_port  // NOLINT
                    : address.ss_family == AF_INET6
                        ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port  // NOLINT
                        : in_port_t{0};
    if (ntohs(in) == port) ::shutdown(file, SHUT_RD);
  }
}

auto too_large(std::uint64_t limit) -> base::Diagnostic {
  return base::error("server-large", "more than " + std::to_string(limit >> 20) + " MB was sent; send less");
}

class Web {
 public:
  Web(const Options& options, Workspace& workspace) : options_(options), workspace_(workspace) {
    http_.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    // Not SO_REUSEPORT, the library's own: another program could then listen beside this one and get its calls.
    http_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http_.set_tcp_nodelay(true);
    http_.set_keep_alive_max_count(100'000);
    // s. A browser keeps connections for later and may, when busy, send on one that was closed while it was not
    // looking; each that waits holds a thread.
    http_.set_keep_alive_timeout(15);
    http_.set_default_headers({{"Content-Security-Policy", content_security_policy},
                               {"X-Content-Type-Options", "nosniff"},
                               {"X-Frame-Options", "DENY"},
                               {"Referrer-Policy", "no-referrer"},
                               {"Cross-Origin-Opener-Policy", "same-origin"},
                               {"Cross-Origin-Resource-Policy", "same-origin"}});
    http_.set_pre_routing_handler([this](const auto& request, auto& response) { return receive(request, response); });
    const auto with_body = [this](const auto& request, auto& response, const auto& reader) {
      receive(request, response, reader);
    };
    for (auto add : {static_cast<AddHandler>(&httplib::Server::Post), static_cast<AddHandler>(&httplib::Server::Put),
                     static_cast<AddHandler>(&httplib::Server::Patch)})
      (http_.*add)(R"([\s\S]*)", with_body);
    http_.set_exception_handler([](const auto&, auto& response, std::exception_ptr) {
      put_and_close(refusal(base::error("bug", "an answer could not be made; please report it")), response);
    });
    http_.set_error_handler(httplib::Server::HandlerWithResponse([](const auto&, httplib::Response& response) {
      if (!response.body.empty() || response.content_length_ != 0) return goes_on;
      const int status = response.status;  // what the library itself refuses: it is not HTTP
      put_and_close(refusal(base::error("server-body", "the request cannot be read")), response);
      response.status = status;
      return answered;
    }));
  }
  Web(const Web&) = delete;
  auto operator=(const Web&) -> Web& = delete;
  ~Web() { stop(); }

  /// Listens from now on. Gives up with "server-port", "server-random".
  auto start() -> base::Result<std::string> {
    const int port = options_.port == 0                                    ? http_.bind_to_any_port(options_.address)
                     : http_.bind_to_port(options_.address, options_.port) ? options_.port
                                                                           : -1;
    if (port < 0)
      return base::error("server-port",
                         "cannot listen there: the port is taken, or the address is not this machine's; choose another "
                         "with --port (0: any that is free)",
                         options_.address + ":" + std::to_string(options_.port));
    auto token = new_token();
    if (!token) return token.error();
    guard_ = std::make_unique<Guard>(options_.address, port, *token);
    port_ = port;
    thread_ = std::thread([this] { http_.listen_after_bind(); });
    while (!http_.is_running()) std::this_thread::sleep_for(1ms);  // stop() before that would be forgotten
    const auto host = options_.address.find(':') == std::string::npos ? options_.address : "[" + options_.address + "]";
    return "http://" + host + ":" + std::to_string(port) + "/#token=" + *token;
  }

  void stop() {
    if (!thread_.joinable()) return;
    http_.stop();
    workspace_.stop();  // lets those go that wait for events
    hear_nothing_more(port_);
    thread_.join();
  }

 private:
  using AddHandler = httplib::Server& (httplib::Server::*)(const std::string&,
                                                           httplib::Server::HandlerWithContentReader);

  auto call_of(const httplib::Request& request) const -> Call {
    Call call{request.method, request.path, {}, {}, header(request, "X-Client").substr(0, 64), {}};
    if (call.method == "HEAD") call.method = "GET";  // the library leaves the body out
    for (const auto& [name, value] : request.params) call.query.emplace(name, value);
    return call;
  }

  auto check(const httplib::Request& request) const -> base::Result<void> {
    std::optional<std::string> origin;
    if (request.has_header("Origin")) origin = header(request, "Origin");
    // Of two hosts the one that was checked might not be the one that counts.
    if (request.get_header_value_count("Host") != 1 || request.get_header_value_count("Origin") > 1)
      return base::error("server-host", "a request has one host and at most one origin");
    return guard_->check(header(request, "Host"), origin);
  }

  static auto is_api(const std::string& path) -> bool { return path == "/api" || path.starts_with("/api/"); }

  /// Who calls, then what. `call` gets what the route captures.
  auto route_of(const httplib::Request& request, Call& call) const -> base::Result<const Route*> {
    if (auto checked = check(request); !checked) return checked.error();
    if (request.path.size() > longest_path) return base::error("server-path", "there is nothing of so long a name");
    if (is_api(request.path))
      if (auto checked = guard_->check_token(header(request, "Authorization")); !checked) return checked.error();
    return find_route(call);
  }

  /// Everything begins here. What has a body goes on to the other receive().
  auto receive(const httplib::Request& request, httplib::Response& response) -> httplib::Server::HandlerResponse {
    // On one machine packing costs more than sending, and nobody needs parts of an answer. The request is the
    // library's own and not constant there.
    auto& mine = const_cast<httplib::Request&>(request);  // NOLINT
    mine.headers.erase("Accept-Encoding");
    mine.ranges.clear();
    const bool sends = request.method == "POST" || request.method == "PUT" || request.method == "PATCH";
    if (sends && request.path.size() <= longest_path && !request.is_multipart_form_data() &&
        !(request.has_header("Content-Length") && request.has_header("Transfer-Encoding")))
      return goes_on;
    auto call = call_of(request);
    if (!sends && !has_body(request) && !is_api(request.path) && call.method == "GET") {
      const auto checked = check(request);
      put(checked ? page(request.path, header(request, "If-None-Match")) : refusal(checked.error()), response);
      return answered;
    }
    const auto route = route_of(request, call);
    if (sends || has_body(request)) {
      put_and_close(
          refusal(route ? base::error("server-body", "a body of this kind is not taken here") : route.error()),
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
      out = upload(call, body);
    } else {
      bool fits = true;
      const bool whole = body.read([&](std::string_view piece) {
        fits = call.body.size() + piece.size() <= json_limit;
        if (fits) call.body += piece;
        return fits;
      });
      out = !fits    ? refusal(too_large(json_limit))
            : !whole ? refusal(base::error("server-body", "the body did not arrive as a whole"))
                     : answer(workspace_, **route, call);
    }
    body.rest() ? put_and_close(out, response) : put(out, response);
  }

  auto upload(const Call& call, Body& body) const -> Answer {
    const auto path = workspace_.upload_path(call.captured.at("name"));
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
    if (!whole) return refusal(base::error("server-body", "the file did not arrive as a whole"));
    if (auto finished = file->finish(); !finished) return refusal(finished.error());
    return {200, "application/json", text_of({{"path", path->string()}}), {}};
  }

  void stream(httplib::Response& response) {
    std::shared_ptr<Listener> listener = workspace_.listen();
    if (!listener) {
      put(refusal(base::error("server-listeners", "too many pages are open on this server; close one")), response);
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
  int port_ = 0;
  std::thread thread_;
};

}  // namespace

auto serve(const Options& options, const base::Cancel& cancel,
           const std::function<void(const std::string& link)>& ready) -> base::Result<void> {
  auto project = Project::open(options.project);
  if (!project) return project.error();
  auto workspace = Workspace::open(std::move(*project), options.sample);
  if (!workspace) return workspace.error();
  Web web(options, **workspace);
  const auto link = web.start();
  if (!link) return link.error();
  ready(*link);
  while (!cancel.requested()) std::this_thread::sleep_for(20ms);
  web.stop();
  return {};
}

auto codes() -> std::vector<base::Code> {
  constexpr int usage = 2, unreadable = 3, bug = 70;
  return {
      {"server-folder", "The folder is not empty and holds no project of mansard.",
       "Name a project's folder, or one that is empty or not there yet.", usage},
      {"server-locked", "Another 'mansard serve' has the project open; two would write over each other.",
       "Use the page of the one that runs, or end it first.", usage},
      {"server-project", "A file of a project cannot be read: cut short by hand, or of another version.",
       "Restore it, or move it away; what the runs left lies in its folder 'runs'.", unreadable},
      {"server-port", "The server cannot listen at the address and port.",
       "Choose another port with --port, or 0 for any that is free.", usage},
      {"server-random", "The system gives no random numbers, so that no token can be made.",
       "Something is wrong with the machine; nothing is served without a token.", bug},
      {"server-token", "A call without the token of the link that 'mansard serve' printed, or with another one.",
       "Open the link that it printed last.", usage},
      {"server-host", "A call by a name that is not the server's own: another site may have been pointed at it.",
       "Open the link that 'mansard serve' printed.", usage},
      {"server-origin", "A call from a page that is not the server's own.",
       "Open the link that 'mansard serve' printed.", usage},
      {"server-path", "Nothing is served by that name.", "/api/openapi.json lists all that can be called.", usage},
      {"server-method", "What is served by that name cannot be called in this way.",
       "/api/openapi.json lists all that can be called.", usage},
      {"server-body", "What was sent cannot be read, or lacks something.", "The message says where; send it right.",
       usage},
      {"server-large", "More was sent than is taken: 16 MB of JSON, or the limit of an uploaded file.",
       "Send less; name large files by their path, or raise --upload-limit.", usage},
      {"server-upload", "A file was uploaded under a name that is not taken.",
       "Rename it: letters, digits, '.', '_', '-', not beginning with a dot.", usage},
      {"server-sample", "There is no sample at hand, or it cannot be read.",
       "Start 'mansard serve' with --sample and a folder of meshes and footprints.", usage},
      {"server-unknown", "A run, a job, a tile, a map or a file is named that is not there.",
       "It may have been deleted; ask for the list again.", usage},
      {"server-no-scene", "The inputs have not been read: none were named, it is under way, or it failed.",
       "Open inputs; wait until they are read; see the message.", usage},
      {"server-not-done", "A run is asked for results that it does not have.",
       "Wait until it is done, or start it again.", usage},
      {"server-busy", "A run that has not ended cannot be deleted.", "Cancel its job first.", usage},
      {"server-inputs",
       "The project has runs of other inputs, and results of two inputs cannot stand beside each other.",
       "Delete the runs, or start 'mansard serve' with another folder.", usage},
      {"server-input", "A database is named where a mesh or a raster belongs.",
       "Name it for the footprints; a mesh is a file, a folder, an archive or a tileset.", usage},
      {"server-import", "Models that are to be opened are in another CRS than the scan of the project.",
       "Open them in a project of their own, or convert one of them.", usage},
      {"server-listeners", "Too many pages listen to the server at once.", "Close some of them.", usage},
      {"edit-invalid", "With this edit a building's models would not be valid, so it was not made.",
       "The message names what is wrong with it; change the plan and try again.", usage},
  };
}

}  // namespace mansard::server
