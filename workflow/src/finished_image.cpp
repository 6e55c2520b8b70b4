// SPDX-License-Identifier: GPL-3.0-or-later
#include "finished_image.h"

#include <fmt/format.h>

#include "job_identity.h"
#include "provenance.h"
#include "simulation_setup.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"

namespace surf::workflow {

void title_by_identity(SimulateJob& job, const std::string& what) {
  job.scene.title.clear();
  const mc::Scan scan =
      resolve_scan(job.scene.scan, mc::extent(job.scene.specimen), job.scene.beam);
  const ResolvedJob resolved = resolve(job);
  const std::string hash = fingerprint(identity_of(resolved, provenance(resolved, scan, {})));
  job.scene.title = fmt::format("{}, {}", what, hash.substr(0, 32));
}

bool is_finished(const SimulateJob& job) {
  const std::filesystem::path& file = job.outputs.front();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    const Image image = io::read_image(file);
    const auto title = image.metadata.find("title");
    return title != image.metadata.end() && title->second == job.scene.title &&
           !image.metadata.contains("partial");
  } catch (const Error&) {
    return false;  // damaged: the image is made again
  }
}

}  // namespace surf::workflow
