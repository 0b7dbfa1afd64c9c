#include "mansard/ingest/input_file.hpp"

#include "mansard/base/files.hpp"
#include "mansard/ingest/detail/hash.hpp"

namespace mansard::ingest {

auto input_file(const std::filesystem::path& path) -> base::Result<InputFile> {
  const auto bytes = base::read_file(path);
  if (!bytes) return bytes.error();
  return InputFile{path.string(), bytes->size(), detail::sha256(*bytes)};
}

}  // namespace mansard::ingest
