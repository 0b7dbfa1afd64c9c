#include "mansard/formats/running_hash.hpp"

#include <openssl/evp.h>
#include <array>

namespace mansard::formats {
namespace {

auto context_of(const std::shared_ptr<void>& owner) -> EVP_MD_CTX* { return static_cast<EVP_MD_CTX*>(owner.get()); }

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), [](void* owned) { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(owned)); }) {
  if (context_ && EVP_DigestInit_ex(context_of(context_), EVP_sha256(), nullptr) != 1) context_.reset();
}

void Sha256::add(std::string_view bytes) {
  if (context_ && EVP_DigestUpdate(context_of(context_), bytes.data(), bytes.size()) != 1) context_.reset();
}

auto Sha256::text() -> std::string {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (!context_ || EVP_DigestFinal_ex(context_of(context_), digest.data(), &size) != 1) return {};
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += "0123456789abcdef"[digest[i] >> 4];
    text += "0123456789abcdef"[digest[i] & 15];
  }
  return text;
}

}  // namespace mansard::formats
