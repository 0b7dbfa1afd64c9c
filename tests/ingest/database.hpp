// A database of its own in a temporary folder, where PostgreSQL and PostGIS are installed; skipped where they are not.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <cstdlib>

#include "ingest/workshop.hpp"

namespace mansard::ingest::test {

/// The folder of initdb and its like, of the newest version that has PostGIS.
inline auto programs() -> fs::path {
  fs::path found;
  std::error_code failure;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", failure)) {
    const auto number = version.path().filename();
    if (fs::exists("/usr/share/postgresql" / number / "extension/postgis.control") &&
        fs::exists(version.path() / "bin/initdb"))
      found = std::max(found, version.path() / "bin");
  }
  return found;
}

class Database : public Workshop {
 protected:
  void SetUp() override {
    if (programs().empty()) GTEST_SKIP() << "PostgreSQL with PostGIS is not installed";
    // PostgreSQL refuses to run as root: in containers its own user does.
    if (::geteuid() == 0) {
      as_ = "runuser -u postgres -- ";
      ASSERT_EQ(std::system(("chown postgres " + at("").string()).c_str()), 0);
    }
    const std::string data = at("data").string();
    run("initdb -D " + data + " -U postgres -A trust --no-sync --no-locale -E UTF8");
    run("pg_ctl -w -D " + data + " -l " + at("log").string() +
        " -o \"-F -c listen_addresses='' -c unix_socket_directories=" + at("").string() + "\" start");
    running_ = !HasFailure();
  }
  void TearDown() override {
    if (running_) run("pg_ctl -D " + at("data").string() + " -m immediate stop");
  }
  void run(const std::string& command) const {
    const std::string whole =
        "cd / && " + as_ + programs().string() + "/" + command + " > " + at("said").string() + " 2>&1";
    if (std::system(whole.c_str()) == 0) return;
    const auto said = base::read_file(at("said"));
    FAIL() << command << "\n" << (said ? *said : "");
  }
  void sql(const std::string& text) const {
    file("do.sql", text);
    run("psql -v ON_ERROR_STOP=1 -q -h " + at("").string() + " -U postgres -d postgres -f " + at("do.sql").string());
  }
  auto address(const std::string& more = "") const -> std::string {
    return "PG:host=" + at("").string() + " dbname=postgres user=postgres" + more;
  }

 private:
  std::string as_;
  bool running_ = false;
};

}  // namespace mansard::ingest::test
