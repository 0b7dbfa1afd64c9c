#include "mansard/formats/given.hpp"

#include "mansard/formats/files/named_file.hpp"

namespace mansard::formats {

auto check_given(const std::filesystem::path& path) -> base::Result<void> {
  if (auto written = check_pipe(path); !written) return written;
  return check_text(path);
}

}  // namespace mansard::formats
