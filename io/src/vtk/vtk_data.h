// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// How the bytes of an array are stored in a VTK file.
struct VtkEncoding {
  enum class Data { text, base64, raw };
  Data data = Data::base64;
  bool big_endian = false;
  bool long_header = false;  ///< counts have 64 bits; false: 32
  bool compressed = false;   ///< by zlib, in blocks
};

/// Says what is wrong with the bytes. The caller adds the place.
struct BadVtkData : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Decodes the bytes of an array that begin at the front of `text`. Allocates no more than a file
/// of this size can hold.
std::string decode_vtk_bytes(std::string_view text, const VtkEncoding& encoding);

/// Reads numbers from bytes. `type` as VTK writes it: "Float32", "Int64" and so on.
std::vector<double> vtk_numbers(const std::string& bytes, const std::string& type, bool big_endian);

/// Reads numbers written as text.
std::vector<double> vtk_numbers_of_text(std::string_view text);

}  // namespace surf::io
