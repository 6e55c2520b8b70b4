// SPDX-License-Identifier: GPL-3.0-or-later
#include "disk_needs.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "extras.h"
#include "simulation_setup.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

double pixels_of(const mc::Scan& scan) { return static_cast<double>(scan.width) * scan.height; }

std::string extension_of(const fs::path& path) {
  std::string text = path.extension().string();
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

fs::path folder_of(const fs::path& file) {
  const fs::path folder = file.parent_path();
  return folder.empty() ? "." : folder;
}

std::string size_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6)
                     : fmt::format("{:.3g} GB", bytes / 1e9);
}

// The nearest existing folder above.
fs::path existing(fs::path folder) {
  std::error_code error;
  folder = fs::weakly_canonical(folder, error);
  while (!fs::exists(folder, error) && folder.has_parent_path() && folder != folder.parent_path())
    folder = folder.parent_path();
  return folder;
}

}  // namespace

std::vector<DiskNeed> disk_needs(const ResolvedJob& job, const mc::Scan& scan,
                                 double packed_bytes) {
  std::vector<DiskNeed> needs;
  const double pixels = pixels_of(scan);
  const auto channels = static_cast<double>(image_like_the_result(job).channels.size());
  double scratch = 0;
  if (const auto tallies = mc::tally_bytes(scan, job.options); tallies > job.options.tally_memory)
    scratch += static_cast<double>(tallies);
  double pyramid = 0;
  for (const fs::path& output : job.outputs) {
    const std::string extension = extension_of(output);
    const bool raster = extension == ".exr" || extension == ".tif" || extension == ".tiff";
    const io::ImageSize size{scan.width, scan.height};
    const bool tiles = raster && io::in_tiles(job.layout, size);
    const double bytes =
        extension == ".png"   ? pixels
        : extension == ".vti" ? 4.0 / 3 * 4 * pixels * channels  // as text
        : raster ? 4 * static_cast<double>(io::stored_pixels(job.layout, size)) * channels
                 : 4 * pixels * channels;
    needs.push_back({output.filename().string(), folder_of(output), bytes, true});
    if (tiles) pyramid = std::max(pyramid, 4 * pixels * channels / 3);
  }
  if (scratch + pyramid > 0 && !job.options.scratch_folder.empty())
    needs.push_back({"scratch file", job.options.scratch_folder, scratch + pyramid, false});
  if (job.checkpoint.wanted && job.extras.deposit_cells == 0 && !job.outputs.empty()) {
    const double usual = pixels * 4 * (1 + static_cast<double>(job.options.detectors.size()));
    needs.push_back(
        {"checkpoint",
         folder_of(job.checkpoint.file.empty() ? job.outputs.front() : job.checkpoint.file),
         packed_bytes > 0 ? packed_bytes : usual, false});
  }
  return needs;
}

std::vector<std::string> warn_of_full_disks(const std::vector<DiskNeed>& needs) {
  struct Disk {
    fs::path folder;
    double bytes = 0;
  };
  std::map<dev_t, Disk> disks;
  for (const DiskNeed& need : needs) {
    const fs::path folder = existing(need.folder);
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0) continue;
    Disk& disk = disks[status.st_dev];
    disk.folder = folder;
    disk.bytes += need.bytes;
  }
  std::vector<std::string> warnings;
  for (const auto& [device, disk] : disks) {
    std::error_code error;
    const fs::space_info space = fs::space(disk.folder, error);
    if (error || static_cast<double>(space.available) >= disk.bytes) continue;
    warnings.push_back(
        fmt::format("{}: {} are free there, and this may take {}", disk.folder.string(),
                    size_text(static_cast<double>(space.available)), size_text(disk.bytes)));
  }
  return warnings;
}

}  // namespace surf::workflow
