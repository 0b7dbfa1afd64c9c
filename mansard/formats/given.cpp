#include "mansard/formats/given.hpp"

#include "mansard/base/files.hpp"
#include "mansard/formats/files/named_file.hpp"

namespace mansard::formats {

auto check_given(const std::filesystem::path& path) -> base::Result<void> {
  if (auto checked = base::check_no_pipe(path); !checked) return checked;
  return check_text(path);
}

}  // namespace mansard::formats
