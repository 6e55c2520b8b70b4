// SPDX-License-Identifier: GPL-3.0-or-later
// What libraries of cascades cost: for each material and energy the bytes and electrons of a
// cascade, the processor time to make 10,000 (of all threads together, so that other work beside
// matters little), and for one page of 2048 the time to make it, to check it, to make its sample,
// to load it.
//   bench_library [cascades, default 10000] [MATERIAL...] [keV...]
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/io/sim/materials.h"
#include "surf/workflow/libraries.h"

namespace {

using namespace surf;

template <class Work>
double seconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

void measure(const std::string& material, double kev, std::size_t cascades) {
  mc::CascadeSettings settings;
  settings.material = io::find_material(material, "bench");
  settings.start_energy_ev = 1000 * kev + settings.material.barrier_ev;
  const auto folder = std::filesystem::temp_directory_path() / "bench_library.tmp";
  std::filesystem::remove_all(folder);
  std::shared_ptr<const mc::CascadeLibrary> library;
  mc::FreshLibraries fresh;
  const double make = seconds([&] { library = fresh.library(settings, cascades, 0, {}); });
  const double share = double(cascades) / double(library->cascades());  // whole pages are made
  const auto statistics = mc::describe(*library, cascades);

  workflow::CachedLibraries(folder).library(settings, 1, 0, {});
  const double load =
      seconds([&] { workflow::CachedLibraries(folder).library(settings, 1, 0, {}); });
  mc::CascadeLibrary empty(settings);
  const auto page = std::make_shared<const mc::CascadePage>(empty.make_page(0, 0));
  const double check = seconds([&] { empty.add_page(page); });
  const double sample = seconds([&] { empty.would_make(*page, 0); });
  std::filesystem::remove_all(folder);
  fmt::print("{:8} {:5g} {:12.0f} {:10.1f} {:9.1f} {:11.2f} {:10.1f} {:10.1f} {:10.1f} {:10.1f}\n",
             material, kev, statistics.bytes_per_cascade, statistics.segments_per_cascade,
             statistics.electrons_per_cascade, make * share * 1e4 / double(cascades),
             1e3 * make * share * double(mc::CascadeLibrary::page_cascades) / double(cascades),
             1e3 * check, 1e3 * sample, 1e3 * load);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t cascades = 10000;
  std::vector<std::string> materials;
  std::vector<double> energies;
  for (int i = 1; i < argc; ++i) {
    const double number = std::atof(argv[i]);
    if (i == 1 && number > 0) cascades = static_cast<std::size_t>(number);
    else if (number > 0) energies.push_back(number);
    else materials.push_back(argv[i]);
  }
  if (materials.empty()) materials = {"Si", "Au"};
  if (energies.empty()) energies = {0.5, 1, 3, 10, 30};
  fmt::print("{:8} {:>5} {:>12} {:>10} {:>9} {:>11} {:>10} {:>10} {:>10} {:>10}\n", "", "keV",
             "bytes each", "segments", "electrons", "make 1e4, s", "page, ms", "check, ms",
             "sample, ms", "load, ms");
  for (const std::string& material : materials)
    for (const double kev : energies) measure(material, kev, cascades);
}
