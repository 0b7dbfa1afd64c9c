// The routes of the API and their handlers.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "apps/server/workspace.hpp"
#include "mansard/base/result.hpp"

namespace mansard::server {

using Words = std::map<std::string, std::string, std::less<>>;

/// A request, independent of the HTTP library.
struct Call {
  std::string method;  ///< "GET"
  std::string path;    ///< decoded
  Words captured;      ///< the values of the {names} in the route
  Words query;
  std::string client;  ///< X-Client
  std::string body;
};

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  Words headers;
};

enum class Sends : std::uint8_t { nothing, json, file };
enum class Gives : std::uint8_t { json, bytes, events };

struct Route {
  std::string_view method, path;  ///< "GET", "/api/runs/{run}/layers"
  Sends sends = Sends::nothing;
  Gives gives = Gives::json;
  std::function<Text(Workspace&, const Call&)> answer;  ///< empty for uploads and events
};

/// All routes, in the order of openapi.json.
[[nodiscard]] auto routes() -> std::span<const Route>;

/// The route of a call; sets `captured` of the call. Fails with "server-path", "server-method".
[[nodiscard]] auto find_route(Call& call) -> base::Result<const Route*>;

/// Answers a call whose body has been received. Failures become refusals.
[[nodiscard]] auto answer(Workspace& workspace, const Route& route, const Call& call) -> Answer;

/// The page and its assets; they need no token.
[[nodiscard]] auto page(std::string_view path, std::string_view known_hash) -> Answer;

/// The answer for a failure, with the HTTP status of its code.
[[nodiscard]] auto refusal(const base::Diagnostic& why) -> Answer;

}  // namespace mansard::server
