// Long work, one piece after the other on a thread of its own, which pages can watch and cancel.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/server/state.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::server {

struct Job {
  std::string id, kind;            ///< kind: "read", "run"
  std::optional<std::string> run;  ///< the run that it makes
  State state = State::queued;
  std::string stage, subject;
  double fraction = 0;  ///< 0 … 1
  std::optional<base::Diagnostic> failure;
};

class Jobs {
 public:
  /// Does the work; "cancelled" is the error of work that was stopped on request.
  using Work = std::function<base::Result<void>(const base::Run&)>;
  /// Told how it ended, before anybody else.
  using Ended = std::function<void(State, const std::optional<base::Diagnostic>&)>;
  using Tell = std::function<void(const Job&)>;

  /// `tell` hears of every change, from any thread.
  explicit Jobs(Tell tell);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  auto operator=(const Jobs&) -> Jobs& = delete;

  auto submit(std::string kind, std::optional<std::string> run, Work work, Ended ended) -> Job;
  /// False: there is no such job. One that has ended stays as it is.
  auto cancel(const std::string& id) -> bool;
  /// Those that wait, the one that runs, and the last that have ended; oldest first.
  [[nodiscard]] auto all() const -> std::vector<Job>;
  [[nodiscard]] auto busy() const -> bool;
  /// Whether one of that kind waits or runs.
  [[nodiscard]] auto pending(const std::string& kind) const -> bool;
  /// Stops the work in hand, which ends as interrupted, and takes up no more.
  void stop();

 private:
  static constexpr std::size_t most_kept = 100;
  struct Entry {
    Job job;
    Work work;
    Ended ended;
    base::Cancel cancel;
  };

  void work_on();
  void carry_out(const std::shared_ptr<Entry>& entry);
  void end(const std::shared_ptr<Entry>& entry, State state, std::optional<base::Diagnostic> failure);
  void forget_old();

  Tell tell_;
  mutable std::mutex mutex_;
  std::condition_variable something_;
  std::list<std::shared_ptr<Entry>> entries_;
  std::size_t next_ = 1;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace mansard::server
