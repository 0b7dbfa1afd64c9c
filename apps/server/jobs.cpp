#include "apps/server/jobs.hpp"

#include <malloc.h>
#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace mansard::server {
namespace {

/// Minimum time between two progress events.
constexpr std::chrono::milliseconds between_reports{100};

auto as_result(const std::function<base::Result<void>()>& work) -> base::Result<void> {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return base::error("memory", "out of memory; read a smaller part of the mesh (ingest.bbox)");
  } catch (const std::exception& e) {
    return base::error("bug", std::string(e.what()) + "; please report it");
  }
}

}  // namespace

Jobs::Jobs(Notify notify) : notify_(std::move(notify)), thread_([this] { work_on(); }) {}

Jobs::~Jobs() { stop(); }

auto Jobs::submit(std::string kind, std::optional<std::string> run, Work work, Ended ended) -> Job {
  auto entry = std::make_shared<Entry>();
  Job job;
  {
    const std::scoped_lock lock(mutex_);
    entry->job.id = "job-" + std::to_string(next_++);
    entry->job.kind = std::move(kind);
    entry->job.run = std::move(run);
    entry->work = std::move(work);
    entry->ended = std::move(ended);
    entries_.push_back(entry);
    job = entry->job;
    forget_old();
  }
  notify_(job);
  something_.notify_all();
  return job;
}

auto Jobs::cancel(const std::string& id) -> bool {
  std::shared_ptr<Entry> waiting;
  {
    const std::scoped_lock lock(mutex_);
    const auto at = std::ranges::find(entries_, id, [](const auto& entry) { return entry->job.id; });
    if (at == entries_.end()) return false;
    (*at)->cancel.request();
    if ((*at)->job.state == State::queued) {
      waiting = *at;
      waiting->job.state = State::cancelled;  // so that the thread does not start it meanwhile
    }
  }
  if (waiting) end(waiting, State::cancelled, std::nullopt);
  return true;
}

auto Jobs::all() const -> std::vector<Job> {
  const std::scoped_lock lock(mutex_);
  std::vector<Job> jobs;
  for (const auto& entry : entries_) jobs.push_back(entry->job);
  return jobs;
}

auto Jobs::busy() const -> bool {
  const std::scoped_lock lock(mutex_);
  return std::ranges::any_of(entries_, [](const auto& entry) { return !over(entry->job.state); });
}

auto Jobs::pending(const std::string& kind) const -> bool {
  const std::scoped_lock lock(mutex_);
  return std::ranges::any_of(entries_,
                             [&](const auto& entry) { return entry->job.kind == kind && !over(entry->job.state); });
}

void Jobs::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    for (const auto& entry : entries_)
      if (entry->job.state == State::running) entry->cancel.request();
  }
  something_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Jobs::work_on() {
  for (;;) {
    std::shared_ptr<Entry> next;
    {
      std::unique_lock lock(mutex_);
      const auto waiting = [&] {
        return std::ranges::find(entries_, State::queued, [](const auto& entry) { return entry->job.state; });
      };
      something_.wait(lock, [&] { return stopping_ || waiting() != entries_.end(); });
      if (stopping_) return;
      next = *waiting();
      next->job.state = State::running;
    }
    carry_out(next);
  }
}

void Jobs::carry_out(const std::shared_ptr<Entry>& entry) {
  {
    Job job;
    {
      const std::scoped_lock lock(mutex_);
      job = entry->job;
    }
    notify_(job);
  }
  auto notified = std::chrono::steady_clock::now() - between_reports;
  base::Run run;
  run.cancel = &entry->cancel;
  run.progress = [&](std::string_view stage, std::string_view subject, double fraction) {
    const auto now = std::chrono::steady_clock::now();
    const bool due = now - notified >= between_reports;
    if (due) notified = now;
    Job job;
    {
      const std::scoped_lock lock(mutex_);
      entry->job.stage = stage;
      entry->job.subject = subject;
      entry->job.fraction = std::clamp(fraction, 0.0, 1.0);
      job = entry->job;
    }
    if (due) notify_(job);
  };
  const auto result = as_result([&] { return entry->work(run); });
  entry->work = nullptr;  // releases what it captured
  // Reading and runs take several times the memory of their results. The C library keeps it for what comes next, which
  // may be nothing.
  ::malloc_trim(0);
  if (result) return end(entry, State::done, std::nullopt);
  if (result.error().code != "cancelled") return end(entry, State::failed, result.error());
  bool stopping = false;
  {
    const std::scoped_lock lock(mutex_);
    stopping = stopping_;
  }
  end(entry, stopping ? State::interrupted : State::cancelled, std::nullopt);
}

void Jobs::end(const std::shared_ptr<Entry>& entry, State state, std::optional<base::Diagnostic> failure) {
  if (entry->ended) entry->ended(state, failure);
  Job job;
  {
    const std::scoped_lock lock(mutex_);
    entry->job.state = state;
    entry->job.failure = std::move(failure);
    if (state == State::done) entry->job.fraction = 1;
    job = entry->job;
  }
  notify_(job);
}

void Jobs::forget_old() {
  for (auto at = entries_.begin(); at != entries_.end() && entries_.size() > most_kept;)
    at = over((*at)->job.state) ? entries_.erase(at) : std::next(at);
}

}  // namespace mansard::server
