// How a run ends where no stage can bring it about: memory runs out anywhere, or nothing has reacted to the request to
// stop. Nothing unfinished is left then either.
#pragma once

#include "mansard/base/run.hpp"

namespace mansard::cli {

/// SIGINT, SIGTERM and SIGHUP request `cancel` from now on, and end the program at once when they come again. To be
/// called before there are other threads.
void stop_on_signals(base::Cancel& cancel);

/// The program ends with "cancelled" where it has not ended 1.5 s after the request: in calls of libraries that know
/// no request.
void stop_in_time();

/// The program ends with "memory", exit code 3, where memory runs out: also in threads, in destructors, and in
/// libraries that call std::abort or would take it for a fault of the data.
void end_without_memory();

/// The message has been printed that the program ends with: memory that runs out on the way out adds none to it.
void an_error_is_reported();

/// For servers: a request for which there is no memory fails from now on, and they go on.
void go_on_without_memory();

/// A file that becomes larger than the process may write is a failed write from now on, and not the end of the process.
void fail_writes_beyond_limit();

}  // namespace mansard::cli
