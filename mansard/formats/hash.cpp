#include "mansard/formats/hash.hpp"

#include <openssl/evp.h>
#include <array>

#include "mansard/base/run.hpp"

namespace mansard::formats {

auto sha256(std::string_view bytes) -> std::string {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) return {};
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += "0123456789abcdef"[digest[i] >> 4];
    text += "0123456789abcdef"[digest[i] & 15];
  }
  return text;
}

auto sha256_beside(std::string_view bytes, const std::function<void()>& work) -> std::string {
  std::string text;
  base::parallel_for(2, [&](std::size_t i) {
    if (i == 0) work();
    else text = sha256(bytes);
  });
  return text;
}

}  // namespace mansard::formats
