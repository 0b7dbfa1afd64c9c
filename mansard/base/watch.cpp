#include "mansard/base/watch.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdint>
#include <ctime>
#include <utility>
#include <vector>

namespace mansard::base {

/// A thread adds its time when it turns to another account, so that a change of account is all that costs.
struct Watch::Account {
  std::atomic<std::int64_t> nanoseconds{0};
  Account* outer = nullptr;
};

namespace {

thread_local Watch::Account* charged = nullptr;
thread_local std::int64_t charged_since = 0;

auto thread_nanoseconds() -> std::int64_t {
  timespec now{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) != 0) return 0;
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Returns the account that was charged before.
auto charge(Watch::Account* account) -> Watch::Account* {
  if (account == charged) return account;
  const std::int64_t now = thread_nanoseconds();
  if (charged != nullptr) charged->nanoseconds.fetch_add(now - charged_since, std::memory_order_relaxed);
  charged_since = now;
  return std::exchange(charged, account);
}

auto seconds(std::chrono::steady_clock::duration duration) -> double {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Watch::Watch() : account_(std::make_unique<Account>()), begin_(std::chrono::steady_clock::now()) {
  account_->outer = charge(account_.get());
}

Watch::~Watch() {
  if (account_) (void)stop();
}

auto Watch::stop() -> Spent {
  assert(account_ && charged == account_.get());
  charge(account_->outer);
  const std::int64_t spent = account_->nanoseconds.load(std::memory_order_relaxed);
  if (account_->outer != nullptr) account_->outer->nanoseconds.fetch_add(spent, std::memory_order_relaxed);
  account_.reset();
  return {static_cast<double>(spent) * 1e-9, seconds(std::chrono::steady_clock::now() - begin_), begin_};
}

auto combined(std::span<const Spent> pieces) -> Spent {
  std::vector<Spent> sorted(pieces.begin(), pieces.end());
  std::ranges::stable_sort(sorted, {}, &Spent::begin);
  Spent sum;
  if (!sorted.empty()) sum.begin = sorted.front().begin;
  double until = 0;  // after sum.begin
  for (const Spent& piece : sorted) {
    sum.cpu_seconds += piece.cpu_seconds;
    const double from = seconds(piece.begin - sum.begin), to = from + piece.wall_seconds;
    sum.wall_seconds += std::max(0.0, to - std::max(from, until));
    until = std::max(until, to);
  }
  return sum;
}

namespace detail {

auto current_account() -> Watch::Account* { return charged; }

Charge::Charge(Watch::Account* account) : before_(charge(account)) {}
Charge::~Charge() { charge(before_); }

}  // namespace detail
}  // namespace mansard::base
