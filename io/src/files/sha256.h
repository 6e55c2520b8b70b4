// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace surf::io {

/// The SHA-256 of bytes that come in pieces. Throws Unsupported if OpenSSL refuses to compute it.
class Sha256 {
 public:
  Sha256();
  ~Sha256();

  void add(const void* data, std::size_t size);
  /// Ends the computation: 64 digits in lower case.
  std::string hexadecimal();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace surf::io
