// SPDX-License-Identifier: GPL-3.0-or-later
// Writing VTP in a build without VTK.
#include "surf/core/error.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

[[noreturn]] void refuse(const std::string& file) {
  throw Unsupported(file, "this semsurf was built without VTK, which writes VTP",
                    "Use another format, or build with VTK");
}

}  // namespace

bool has_vtp_writer() { return false; }

std::string format_vtp(const std::string& file, const SceneView&) { refuse(file); }

std::string format_tracks(const std::string& file, std::span<const Track>,
                          const std::map<std::string, std::string>&) {
  refuse(file);
}

}  // namespace surf::io
