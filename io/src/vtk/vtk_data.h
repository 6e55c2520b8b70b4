// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// How VTK wrote an array's bytes.
struct VtkEncoding {
  enum class Data { text, base64, raw };
  Data data = Data::base64;
  bool big_endian = false;
  bool long_header = false;  ///< counts of 64 bits, else of 32
  bool compressed = false;   ///< by zlib, in blocks
};

/// What is wrong with the bytes; the caller knows the place.
struct BadVtkData : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of an array that begin at the front of `text`. Allocates no more than a file of this
/// size can hold.
std::string decode_vtk_bytes(std::string_view text, const VtkEncoding& encoding);

/// The numbers in the bytes. `type` as VTK writes it: "Float32", "Int64" and so on.
std::vector<double> vtk_numbers(const std::string& bytes, const std::string& type, bool big_endian);

/// Numbers written as text.
std::vector<double> vtk_numbers_of_text(std::string_view text);

}  // namespace surf::io
