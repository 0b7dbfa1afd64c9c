#include "apps/server/changed_files.hpp"

#include "mansard/formats/input_file.hpp"
#include "mansard/formats/input_name.hpp"

namespace mansard::server {

auto ChangedFiles::changed(const KnownFile& file) -> bool {
  const auto place = formats::disk_place_of(file.path);
  if (!place) return false;
  const auto stamp = stamp_of(*place);
  if (!stamp) return true;
  if (*stamp == file.stamp) return false;
  const std::scoped_lock lock(mutex_);
  auto& known = checked_[file.path + " " + file.sha256];
  if (known.stamp != *stamp) {
    const auto now = formats::input_file(file.path);
    known = {*stamp, !now || now->sha256 != file.sha256};
  }
  return known.changed;
}

}  // namespace mansard::server
