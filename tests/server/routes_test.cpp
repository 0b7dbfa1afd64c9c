#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "apps/server/assets.hpp"
#include "apps/server/routes.hpp"

namespace mansard::server {
namespace {

using Json = nlohmann::ordered_json;

auto upper(std::string text) -> std::string {
  for (auto& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

TEST(Routes, are_those_of_openapi_json) {
  const auto api = Json::parse(openapi());
  std::set<std::string> described, served;
  for (const auto& [path, methods] : api["paths"].items())
    for (const auto& [method, operation] : methods.items()) described.insert(upper(method) + " " + path);
  for (const auto& route : routes()) served.insert(std::string(route.method) + " " + std::string(route.path));
  EXPECT_THAT(served, testing::ContainerEq(described));
  EXPECT_EQ(served.size(), routes().size()) << "a route is listed twice";
}

TEST(Routes, accept_and_return_the_types_of_openapi_json) {
  const auto api = Json::parse(openapi());
  for (const auto& route : routes()) {
    auto method = std::string(route.method);
    for (auto& c : method) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto& operation = api["paths"][std::string(route.path)][method];
    const auto& given = operation["responses"]["200"]["content"];
    const auto kind = given.contains("application/json")    ? Gives::json
                      : given.contains("text/event-stream") ? Gives::events
                                                            : Gives::bytes;
    EXPECT_EQ(route.gives, kind) << route.path;
    if (!operation.contains("requestBody")) continue;
    const auto& taken = operation["requestBody"]["content"];
    EXPECT_EQ(route.sends, taken.contains("application/json") ? Sends::json : Sends::file) << route.path;
  }
}

TEST(Routes, capture_parameters_and_refuse_unknown_paths) {
  Call call{"GET", "/api/runs/run-3/error/block-1", {}, {}, {}, {}};
  const auto route = find_route(call);
  ASSERT_TRUE(route);
  EXPECT_EQ((*route)->path, "/api/runs/{run}/error/{block}");
  EXPECT_EQ(call.captured.at("run"), "run-3");
  EXPECT_EQ(call.captured.at("block"), "block-1");
  for (const auto* path : {"/api", "/api/", "/api/runs/", "/api/runs/run-3/layers/", "/api/nothing", "//api/status"}) {
    Call other{"GET", path, {}, {}, {}, {}};
    const auto none = find_route(other);
    EXPECT_TRUE(!none || (*none)->path == "/api/runs/{run}") << path;
    if (!none) {
      EXPECT_THAT(none.error().code, testing::AnyOf("server-path", "server-method")) << path;
    }
  }
  Call wrong{"PUT", "/api/status", {}, {}, {}, {}};
  EXPECT_EQ(find_route(wrong).error().code, "server-method");
}

TEST(Page, is_served_under_its_names_only) {
  EXPECT_EQ(page("/", "").status, 200);
  EXPECT_THAT(page("/", "").body, testing::HasSubstr("<!doctype html>"));
  EXPECT_EQ(page("/index.html", "").status, 200);
  for (const auto* path :
       {"", "index.html", "/../server.cpp", "/..", "//etc/passwd", "/assets/", "/assets/../index.html", "/%2e%2e"})
    EXPECT_EQ(page(path, "").status, 404) << path;
  const auto tag = page("/", "").headers.at("ETag");
  EXPECT_EQ(page("/", tag).status, 304);
  EXPECT_EQ(page("/", tag).body, "");
}

}  // namespace
}  // namespace mansard::server
