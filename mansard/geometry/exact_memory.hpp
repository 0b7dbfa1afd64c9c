// The memory of exact numbers.
#pragma once

namespace mansard::geometry {

/// Where there is no memory for an exact number, the new handler of the process (std::set_new_handler) is called from
/// now on. By itself GMP prints a line and aborts.
void exact_numbers_end_by_new_handler();

}  // namespace mansard::geometry
