// A property over random plans: run by rapidcheck, made small by our own means when it fails.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "mansard/model/plan.hpp"

namespace plans {

/// What is wrong with a plan or with what became of it, "" when nothing is. The first word names the kind of fault.
using Property = std::function<std::string(const mansard::model::Plan&)>;

/// Checks a property over a per-mille share of the runs (5,000 in all; MANSARD_RUNS says another number) in the running
/// test. `size` is about the most corners of a ring. RC_PARAMS ("seed=… max_success=…") steers rapidcheck as usual; a
/// failure's message gives the seed to say there, and the plan made small, which goes into fixtures/ when the
/// environment has MANSARD_KEEP_FAILURES. An exception is a fault.
void for_all_plans(int per_mille, std::size_t size, const Property& property);

}  // namespace plans
