// SPDX-License-Identifier: GPL-3.0-or-later
#include "upstream.h"

#include <vtkAlgorithm.h>

#include <set>
#include <utility>

#include "surf/core/error.h"
#include "surf/io/sim/scene_file.h"
#include "vtkSemsurfImageReader.h"
#include "vtkSemsurfMeshReader.h"
#include "vtkSemsurfScanReader.h"
#include "vtkSemsurfSceneReader.h"

namespace surf::pv {
namespace {

namespace fs = std::filesystem;

template <class Reader>
const char* file_of(vtkAlgorithm* algorithm) {
  auto* const reader = dynamic_cast<Reader*>(algorithm);
  return reader ? reader->GetFileName() : nullptr;
}

std::string file_read(vtkAlgorithm* algorithm) {
  for (const char* file :
       {file_of<vtkSemsurfImageReader>(algorithm), file_of<vtkSemsurfMeshReader>(algorithm),
        file_of<vtkSemsurfScanReader>(algorithm), file_of<vtkSemsurfSceneReader>(algorithm)})
    if (file) return file;
  return {};
}

std::vector<fs::path> files_with(const fs::path& path) {
  try {
    return io::is_scene_file(path) ? io::scene_input_files(path) : io::files_read_with(path);
  } catch (const Error&) {
    return {path};  // the reader says what is wrong
  }
}

void collect(vtkAlgorithm* algorithm, std::set<vtkAlgorithm*>& seen,
             std::vector<io::FileUse>& inputs) {
  if (!algorithm || !seen.insert(algorithm).second) return;
  if (const fs::path path = file_read(algorithm); !path.empty())
    for (const fs::path& file : files_with(path))
      inputs.push_back({"Input", file, file == path ? fs::path() : path});
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port)
    for (int i = 0; i < algorithm->GetNumberOfInputConnections(port); ++i)
      collect(algorithm->GetInputAlgorithm(port, i), seen, inputs);
}

}  // namespace

void refuse_overlaps(vtkAlgorithm* self, const std::vector<io::FileUse>& outputs,
                     std::vector<io::FileUse> more) {
  std::set<vtkAlgorithm*> seen;
  collect(self, seen, more);
  io::refuse_overlaps(more, outputs);
}

}  // namespace surf::pv
