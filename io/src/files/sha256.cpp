// SPDX-License-Identifier: GPL-3.0-or-later
#include "sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <span>

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

void check(bool done) {
  if (!done) {
    throw Unsupported("SHA-256", "OpenSSL refuses to compute it", "Check its configuration");
  }
}

}  // namespace

struct Sha256::Context {
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> evp{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  EVP_MD_CTX* const evp = context_->evp.get();
  check(evp && EVP_DigestInit_ex(evp, EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() = default;

void Sha256::add(const void* data, std::size_t size) {
  check(EVP_DigestUpdate(context_->evp.get(), data, size) == 1);
}

std::string Sha256::hexadecimal() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  check(EVP_DigestFinal_ex(context_->evp.get(), digest.data(), &size) == 1);
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string sha256_of(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hexadecimal();
}

}  // namespace surf::io
