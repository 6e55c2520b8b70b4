// SPDX-License-Identifier: GPL-3.0-or-later
#include "gwyddion_program.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "files/run_program.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

/// A folder of our own, removed with all that is in it.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (fs::temp_directory_path() / "semsurf-gwyddion-XXXXXX").string();
    if (!::mkdtemp(name.data())) {
      throw FileError(name, std::strerror(errno),
                      "Check the folder for temporary files, $TMPDIR or /tmp");
    }
    path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

std::optional<std::string> convert_by_gwyddion(const fs::path& path) {
  const WorkFolder folder;
  const fs::path result = folder.path() / "converted.gwy";
  const ProgramEnd end =
      run_program({"gwyddion", "--no-log-to-file", "--convert-to-gwy=" + result.string(),
                   fs::absolute(path).string()},
                  "");
  if (!end.started || end.code == 127) return std::nullopt;
  std::error_code error;
  if (end.code != 0 || !fs::is_regular_file(result, error)) {
    throw UnknownScan(path.string(),
                      "neither semsurf nor Gwyddion, which was asked too, can read it as a scan",
                      "Export the scan as .gwy, .gsf or text");
  }
  return read_file(result);
}

}  // namespace surf::io
