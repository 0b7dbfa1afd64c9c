#include "mansard/formats/input_file.hpp"

#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/hash.hpp"

namespace mansard::formats {

auto input_file(const std::filesystem::path& path) -> base::Result<model::InputFile> {
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.error();
  return model::InputFile{path.string(), bytes->view().size(), sha256(bytes->view())};
}

}  // namespace mansard::formats
