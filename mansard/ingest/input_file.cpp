#include "mansard/ingest/input_file.hpp"

#include "mansard/ingest/detail/hash.hpp"
#include "mansard/ingest/detail/virtual_files.hpp"

namespace mansard::ingest {

auto input_file(const std::filesystem::path& path) -> base::Result<InputFile> {
  const auto bytes = detail::Bytes::of(path);
  if (!bytes) return bytes.error();
  return InputFile{path.string(), bytes->view().size(), detail::sha256(bytes->view())};
}

}  // namespace mansard::ingest
