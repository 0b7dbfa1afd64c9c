#include <gtest/gtest.h>

#include "apps/server/guard.hpp"

namespace mansard::server {
namespace {

auto code(const base::Result<void>& result) -> std::string { return result ? "" : result.error().code; }

TEST(Guard, accepts_its_own_address_and_localhost_and_no_other_name) {
  const Guard guard("127.0.0.1", 8642, "secret");
  for (const auto* host : {"127.0.0.1:8642", "localhost:8642", "LOCALHOST:8642"})
    EXPECT_EQ(code(guard.check(host, {})), "") << host;
  for (const auto* host :
       {"", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:86420", "evil.example:8642", "127.0.0.1.evil.example:8642",
        "[::1]:8642", "127.0.0.2:8642", "127.0.0.1:8642@evil.example", ":8642", "localhost.:8642"})
    EXPECT_EQ(code(guard.check(host, {})), "server-host") << host;
}

TEST(Guard, accepts_its_own_pages_and_no_others) {
  const Guard guard("127.0.0.1", 8642, "secret");
  for (const auto* origin : {"http://127.0.0.1:8642", "http://localhost:8642"})
    EXPECT_EQ(code(guard.check("127.0.0.1:8642", origin)), "") << origin;
  for (const auto* origin : {"null", "", "https://127.0.0.1:8642", "http://127.0.0.1:8643", "http://evil.example",
                             "http://evil.example:8642", "http://127.0.0.1:8642.evil.example", "file://"})
    EXPECT_EQ(code(guard.check("127.0.0.1:8642", origin)), "server-origin") << origin;
}

TEST(Guard, on_all_addresses_accepts_ip_addresses_but_no_names) {
  const Guard guard("0.0.0.0", 80, "secret");
  for (const auto* host : {"192.168.1.7", "192.168.1.7:80", "localhost"})
    EXPECT_EQ(code(guard.check(host, {})), "") << host;
  for (const auto* host : {"evil.example", "192.168.1.7:8080"})
    EXPECT_EQ(code(guard.check(host, {})), "server-host") << host;
  const Guard six("::1", 8642, "secret");
  EXPECT_EQ(code(six.check("[::1]:8642", {})), "");
  EXPECT_EQ(code(six.check("::1:8642", {})), "server-host");
}

TEST(Guard, accepts_the_complete_token_only) {
  const Guard guard("127.0.0.1", 8642, "secret");
  EXPECT_EQ(code(guard.check_token("Bearer secret")), "");
  for (const auto* given : {"", "Bearer", "Bearer ", "secret", "Bearer secre", "Bearer secrets", "Bearer Secret",
                            "Basic secret", "bearer secret"})
    EXPECT_EQ(code(guard.check_token(given)), "server-token") << given;
}

TEST(Guard, makes_tokens_of_128_bits_that_differ) {
  const auto a = new_token(), b = new_token();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->size(), 32U);
  EXPECT_NE(*a, *b);
}

TEST(Guard, recognises_loopback_addresses) {
  for (const auto* address : {"127.0.0.1", "127.8.8.8", "localhost", "::1"})
    EXPECT_TRUE(is_loopback(address)) << address;
  for (const auto* address : {"0.0.0.0", "192.168.1.7", "127.evil.example", "::"})
    EXPECT_FALSE(is_loopback(address)) << address;
}

}  // namespace
}  // namespace mansard::server
