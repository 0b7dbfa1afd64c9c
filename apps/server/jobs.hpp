// Long tasks, run one after the other on a separate thread. Pages can watch and cancel them.
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
  std::string id, kind;            ///< kind: "read", "run", "textures"
  std::optional<std::string> run;  ///< the run that the job computes
  State state = State::queued;
  std::string stage, subject;
  double fraction = 0;  ///< 0 … 1
  std::optional<base::Diagnostic> failure;
};

class Jobs {
 public:
  /// The task; it fails with "cancelled" when it is stopped on request.
  using Work = std::function<base::Result<void>(const base::Run&)>;
  /// Called with the final state before `Notify` is.
  using Ended = std::function<void(State, const std::optional<base::Diagnostic>&)>;
  using Notify = std::function<void(const Job&)>;

  /// `notify` is called after every change, from any thread.
  explicit Jobs(Notify notify);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  auto operator=(const Jobs&) -> Jobs& = delete;

  auto submit(std::string kind, std::optional<std::string> run, Work work, Ended ended) -> Job;
  /// False for an unknown job. A job that has ended stays as it is.
  auto cancel(const std::string& id) -> bool;
  /// Queued and running jobs and the last ones that have ended, oldest first.
  [[nodiscard]] auto all() const -> std::vector<Job>;
  [[nodiscard]] auto busy() const -> bool;
  /// Whether a job of that kind is queued or running.
  [[nodiscard]] auto pending(const std::string& kind) const -> bool;
  /// Stops the running job, whose state becomes "interrupted", and starts no other.
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

  Notify notify_;
  mutable std::mutex mutex_;
  std::condition_variable something_;
  std::list<std::shared_ptr<Entry>> entries_;
  std::size_t next_ = 1;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace mansard::server
