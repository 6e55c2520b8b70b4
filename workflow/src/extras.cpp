// SPDX-License-Identifier: GPL-3.0-or-later
#include "extras.h"

#include <algorithm>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/surface_view.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr int most_trajectories = 100'000;
constexpr int most_deposit_cells = 1024;

const std::map<std::string, std::vector<std::string>>& surface_quantities() {
  static const std::map<std::string, std::vector<std::string>> all{
      {"z_nm", {"z_nm"}},
      {"normal", {"normal.x", "normal.y", "normal.z"}},
      {"material", {"material"}}};
  return all;
}

void add_rows(std::string& text, const mc::SimulationResult& result, std::size_t detector,
              const char* quantity, const char* unit, const mc::Histogram& histogram) {
  const mc::Detector& d = result.detectors[detector];
  for (std::size_t i = 0; i < histogram.bins.size(); ++i) {
    const mc::Estimate e = mc::estimate(result.balance.incident, histogram.bins[i]);
    text += fmt::format("{},{},{},{},{},{},{}\n", d.name, quantity, unit,
                        format_exact(histogram.edge(i)), format_exact(histogram.edge(i + 1)),
                        format_exact(e.mean * d.efficiency),
                        format_exact(e.standard_error * d.efficiency));
  }
}

}  // namespace

fs::path extra_path(const SimulateJob& job, const char* extension) {
  fs::path path = job.outputs.front();
  return path.replace_extension(extension);
}

void check_extras(const Extras& extras) {
  for (const std::string& name : extras.surface)
    if (!surface_quantities().contains(name))
      throw UsageError("--channels", fmt::format("there is no '{}'", name),
                       "Choose among z_nm, normal and material");
  if (extras.deposit_cells < 0 || extras.deposit_cells > most_deposit_cells)
    throw UsageError("--deposit", fmt::format("{} cells are out of range", extras.deposit_cells),
                     "Give 1 to 1024 cells along the longest side");
  if (extras.trajectories < 0 || extras.trajectories > most_trajectories)
    throw UsageError("--trajectories", fmt::format("{} is out of range", extras.trajectories),
                     "Give 1 to 100000 primaries; 50 make a clear picture");
  if (extras.trajectories_at_nm && extras.trajectories == 0)
    throw UsageError("--trajectories-at", "no trajectories are asked for", "Add --trajectories 50");
}

std::vector<fs::path> extra_files(const SimulateJob& job) {
  std::vector<fs::path> files;
  if (job.options.spectra) files.push_back(extra_path(job, ".spectra.csv"));
  if (job.extras.deposit_cells > 0) files.push_back(extra_path(job, ".deposit.vti"));
  if (job.extras.trajectories > 0) {
    files.push_back(extra_path(job, ".tracks.vtp"));
    files.push_back(extra_path(job, ".tracks.png"));
  }
  return files;
}

std::vector<std::string> surface_channels(const Extras& extras) {
  std::vector<std::string> names;
  for (const std::string& wanted : extras.surface)
    for (const std::string& name : surface_quantities().at(wanted))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

void add_surface_channels(const mc::Scene& scene, const SimulateJob& job, ImageRows& image) {
  const auto names = surface_channels(job.extras);
  if (names.empty()) return;
  const Image view = mc::surface_view(scene, job.options.threads);
  const auto seen = std::make_shared<Image>();
  for (const std::string& name : names) {
    const Channel& channel = *view.find(name);
    image.head.channels.push_back({channel.name, channel.unit, {}});
    seen->channels.push_back(channel);
  }
  const std::size_t before = image.head.channels.size() - names.size();
  image.read = [simulated = image.read, before, seen, extra = rows_of(*seen).read](
                   std::size_t channel, int y, std::span<float> row) {
    if (channel < before) simulated(channel, y, row);
    else extra(channel - before, y, row);
  };
}

std::string spectra_text(const mc::SimulationResult& result) {
  std::string text = "detector,quantity,unit,from,to,yield,standard_error\n";
  for (std::size_t d = 0; d < result.spectra.size(); ++d) {
    add_rows(text, result, d, "energy", "eV", result.spectra[d].energy_ev);
    add_rows(text, result, d, "polar", "deg", result.spectra[d].polar_deg);
    add_rows(text, result, d, "azimuth", "deg", result.spectra[d].azimuth_deg);
  }
  return text;
}

Deposits::Deposits(const mc::Scene& scene, int cells, int threads)
    : grid_(mc::deposit_grid(scene, cells)),
      per_thread_(static_cast<std::size_t>(threads), mc::EnergyDeposit(grid_)) {}

Volume Deposits::density(std::int64_t primaries) const {
  mc::EnergyDeposit all(grid_);
  for (const mc::EnergyDeposit& d : per_thread_) all += d;
  return all.density(primaries);
}

}  // namespace surf::workflow
