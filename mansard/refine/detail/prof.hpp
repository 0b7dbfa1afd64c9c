#pragma once
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>
namespace prof {
struct Row { double incl = 0, self = 0; long n = 0; };
struct Table { std::map<std::string, Row> rows; std::vector<double*> stack; ~Table() { if (std::getenv("PROF")) for (auto& [k, r] : rows) std::fprintf(stderr, "PROF %-28s n %7ld incl %8.3f self %8.3f\n", k.c_str(), r.n, r.incl, r.self); } };
inline auto table() -> Table& { static Table t; return t; }
struct Timer {
  std::string name; std::chrono::steady_clock::time_point t0 = std::chrono::steady_clock::now(); double child = 0;
  explicit Timer(std::string n) : name(std::move(n)) { table().stack.push_back(&child); }
  ~Timer() { const double d = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(); auto& t = table(); t.stack.pop_back(); if (!t.stack.empty()) *t.stack.back() += d; auto& r = t.rows[name]; r.n++; r.incl += d; r.self += d - child; }
};
}  // namespace prof
