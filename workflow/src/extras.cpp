// SPDX-License-Identifier: GPL-3.0-or-later
#include "extras.h"

#include <algorithm>
#include <array>
#include <functional>
#include <span>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/surface_view.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr int most_trajectories = 100'000;
constexpr int most_deposit_cells = 1024;

using Quantities = std::map<std::string, std::vector<std::string>>;

const Quantities& surface_quantities() {
  static const Quantities all{{"z_nm", {"z_nm"}},
                              {"normal", {"normal.x", "normal.y", "normal.z"}},
                              {"material", {"material"}}};
  return all;
}

// Channels about the simulation; from "variance_left" on there are some for each detector.
constexpr std::array<const char*, 6> simulation_quantities{"electrons", "model",  "variance_left",
                                                           "counts",    "radius", "plain"};

bool is_simulation_quantity(const std::string& name) {
  return std::find(simulation_quantities.begin(), simulation_quantities.end(), name) !=
         simulation_quantities.end();
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<std::string> surface_channels(const Extras& extras) {
  std::vector<std::string> names;
  for (const std::string& wanted : extras.channels)
    if (!is_simulation_quantity(wanted))
      for (const std::string& name : surface_quantities().at(wanted)) add_once(names, name);
  return names;
}

struct PixelChannel {
  std::string name;
  std::function<double(int x, int y)> value;
};

// What can be counted of a detector's primaries, all of them and those of odd number.
void add_counts(const mc::SimulationResult& r, std::size_t d, std::vector<PixelChannel>& out) {
  const std::string& name = r.detectors[d].name;
  out.push_back({name + ".sum", [&r, d](int x, int y) { return double(r.counts[d](x, y).sum); }});
  out.push_back(
      {name + ".squares", [&r, d](int x, int y) { return double(r.counts[d](x, y).squares); }});
  out.push_back(
      {name + ".odd_sum", [&r, d](int x, int y) { return double(r.odd_counts[d](x, y).sum); }});
  out.push_back({name + ".odd_squares",
                 [&r, d](int x, int y) { return double(r.odd_counts[d](x, y).squares); }});
}

// The result refers to `r` and `guided`.
std::vector<PixelChannel> simulation_channels(const Extras& extras, const mc::SimulationResult& r,
                                              const std::vector<GuidedImage>& guided) {
  std::vector<PixelChannel> out;
  for (const char* wanted : simulation_quantities) {
    const std::string name = wanted;
    if (std::find(extras.channels.begin(), extras.channels.end(), name) == extras.channels.end())
      continue;
    if (name == "electrons")
      out.push_back({name, [&r](int x, int y) { return double(r.pixels(x, y).primaries); }});
    else if (name == "model")
      out.push_back({name, [&r](int x, int y) {
                       const auto& p = r.pixels(x, y);
                       return p.hits > 0 ? double(static_cast<int>(p.model)) : 0.0;
                     }});
    else
      for (std::size_t d = 0; d < r.detectors.size(); ++d) {
        const std::string& detector = r.detectors[d].name;
        if (name == "counts") add_counts(r, d, out);
        else if (name == "radius")
          out.push_back({detector + ".radius",
                         [&guided, d](int x, int y) { return guided[d].radius_px(x, y); }});
        else if (name == "plain") {
          out.push_back(
              {detector + ".plain", [&r, d](int x, int y) { return r.yield(d, x, y).mean; }});
          out.push_back({detector + ".plain.stderr",
                         [&r, d](int x, int y) { return r.yield(d, x, y).standard_error; }});
        } else
          out.push_back({detector + "." + name, [&r, d](int x, int y) {
                           return r.controls.empty() ? 1.0 : r.controls[d](x, y).variance_left;
                         }});
      }
  }
  return out;
}

std::string model_meanings() {
  std::string text;
  for (int i = 0; i < mc::pixel_models; ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, mc::name(static_cast<mc::PixelModel>(i)));
  return text;
}

// Appends channels to the image, read row by row.
void append(ImageRows& image, std::vector<Channel> heads,
            std::function<void(std::size_t, int, std::span<float>)> read) {
  const std::size_t before = image.head.channels.size();
  for (Channel& head : heads) image.head.channels.push_back(std::move(head));
  image.read = [first = image.read, before, read = std::move(read)](std::size_t channel, int y,
                                                                    std::span<float> row) {
    if (channel < before) first(channel, y, row);
    else read(channel - before, y, row);
  };
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

fs::path extra_path(const ResolvedJob& job, const char* extension) {
  fs::path path = job.outputs.front();
  return path.replace_extension(extension);
}

void check_extras(const Extras& extras) {
  for (const std::string& name : extras.channels)
    if (!surface_quantities().contains(name) && !is_simulation_quantity(name))
      throw UsageError(
          "`output.channels`", fmt::format("there is no '{}'", name),
          "Choose among z_nm, normal, material, electrons, model, variance_left, counts, "
          "radius and plain");
  if (extras.deposit_cells < 0 || extras.deposit_cells > most_deposit_cells)
    throw UsageError("`output.deposit`",
                     fmt::format("{} cells are out of range", extras.deposit_cells),
                     "Give 1 to 1024 cells along the longest side");
  if (extras.trajectories < 0 || extras.trajectories > most_trajectories)
    throw UsageError("`output.trajectories`",
                     fmt::format("{} is out of range", extras.trajectories),
                     "Give 1 to 100000 primaries; 50 make a clear picture");
  if (extras.trajectories_at_nm && extras.trajectories == 0)
    throw UsageError("`output.trajectories_at`", "no trajectories are asked for",
                     "Add `output.trajectories=50`");
}

bool wants_counts(const Extras& extras) {
  return std::ranges::find(extras.channels, "counts") != extras.channels.end();
}

void check_extras_of(const ResolvedJob& job) {
  const bool guided = job.estimate.kind == Estimate::guided;
  for (const std::string& name : job.extras.channels)
    if (!guided && (name == "radius" || name == "plain"))
      throw UsageError(
          "`output.channels`",
          fmt::format("'{}' is of guided estimates, and the image is a plain one", name),
          "Add `simulation.estimate=guided`, or leave it out");
  if (wants_counts(job.extras) && !guided && mc::accuracy_of(job.options.budget) > 0)
    throw UsageError("`output.channels`",
                     "with an accuracy counts are of differences to planes, which tell nobody else "
                     "anything",
                     "Give `simulation.electrons`, or leave 'counts' out");
}

std::vector<fs::path> extra_files(const ResolvedJob& job) {
  std::vector<fs::path> files;
  if (job.options.spectra) files.push_back(extra_path(job, ".spectra.csv"));
  if (job.extras.deposit_cells > 0) files.push_back(extra_path(job, ".deposit.vti"));
  if (job.extras.trajectories > 0) {
    files.push_back(extra_path(job, ".tracks.vtp"));
    files.push_back(extra_path(job, ".tracks.png"));
  }
  return files;
}

std::vector<std::string> label_channels() { return {"material", "model", "valid"}; }

std::vector<std::string> extra_channels(const ResolvedJob& job) {
  std::vector<std::string> names = surface_channels(job.extras);
  mc::SimulationResult like;
  like.detectors = job.options.detectors;
  for (const PixelChannel& c : simulation_channels(job.extras, like, {})) names.push_back(c.name);
  return names;
}

void add_channels(const mc::Scene& scene, const ResolvedJob& job,
                  const mc::SimulationResult& result, const std::vector<GuidedImage>& guided,
                  ImageRows& image) {
  if (const auto names = surface_channels(job.extras); !names.empty()) {
    const double bytes =
        4.0 * static_cast<double>(names.size()) * static_cast<double>(result.pixels.size());
    const bool large = bytes > static_cast<double>(job.options.tally_memory);
    ImageRows seen = mc::surface_view_rows(scene, names, job.options.threads,
                                           large ? job.options.scratch_folder : std::string());
    append(image, std::move(seen.head.channels), std::move(seen.read));
  }
  auto channels = simulation_channels(job.extras, result, guided);
  if (channels.empty()) return;
  std::vector<Channel> heads;
  for (const PixelChannel& c : channels) {
    heads.push_back({c.name, "1", {}});
    if (c.name == "model") image.head.metadata["model"] = model_meanings();
  }
  append(
      image, std::move(heads),
      [channels = std::move(channels), &result](std::size_t channel, int y, std::span<float> row) {
        for (std::size_t x = 0; x < row.size(); ++x)
          row[x] = static_cast<float>(channels[channel].value(static_cast<int>(x), y));
        if (y % 64 == 0) result.release();
      });
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
