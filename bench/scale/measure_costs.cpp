// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <vector>

#include "checkpoint.h"
#include "scenes.h"
#include "surf/core/random.h"
#include "surf/io/image_file.h"
#include "surf/mc/results/serialize.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "surf/mc/simulate.h"

namespace surf::scale {
namespace {

namespace fs = std::filesystem;

constexpr double view_nm = 192;

// Others on the machine don't count.
double processor_s(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Units {
  std::vector<double> durations_s;
  std::vector<mc::UnitTally> tallies;
};

// Of the large image, at random places.
Units simulate_directly(const mc::Scene& scene, std::int64_t electrons, int pixels, int count) {
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{electrons};
  Units out;
  RandomStream random(7, 0, static_cast<std::uint32_t>(pixels));
  for (int i = 0; i <= count; ++i) {
    const int x = static_cast<int>(random.uniform() * (side - pixels)),
              y = static_cast<int>(random.uniform() * side);
    const double begin = processor_s();
    mc::UnitTally tally =
        mc::simulate_unit(scene, options, {x, y, x + pixels, y + 1, 0, electrons});
    if (i == 0) continue;  // warms up
    out.durations_s.push_back(processor_s() - begin);
    out.tallies.push_back(std::move(tally));
  }
  return out;
}

class Clocked : public mc::UnitJournal {
 public:
  bool recall(std::size_t, mc::UnitTally&) override { return false; }
  void record(std::size_t, const mc::UnitTally& tally) override {
    const double now = processor_s(CLOCK_PROCESS_CPUTIME_ID);
    if (last_s_ > 0) {
      units.durations_s.push_back(now - last_s_);
      units.tallies.push_back(tally);
    }
    last_s_ = processor_s(CLOCK_PROCESS_CPUTIME_ID);
  }
  Units units;

 private:
  double last_s_ = 0;
};

// Tiles of a smaller image of the same place, one after the other as they come: they have as many
// pixels, and share what they read of the library.
Units simulate_by_replay(std::int64_t electrons, int pixels_across, mc::LibrarySource& libraries) {
  const mc::Scan scan = bench::view(view_nm, pixels_across);
  const mc::Scene scene(bench::mesa(bench::only_silicon()), bench::beam(1000), scan);
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{electrons};
  options.method = mc::Method::replay;
  options.threads = 1;
  Clocked journal;
  mc::simulate(scene, options, {.journal = &journal, .libraries = &libraries});
  return journal.units;
}

struct Handling {
  double pack_s = 0, unpack_s = 0, merge_s = 0, bytes = 0;
};

// Into an image large enough for a scratch file, row by row as units come; kept as a checkpoint
// does.
Handling handle(const std::vector<mc::UnitTally>& tallies, const fs::path& folder,
                std::int64_t pixels) {
  const int width = tallies.front().pixels.width(), height = tallies.front().pixels.height();
  const int across = 4096 / width;
  const auto count = std::max<std::int64_t>(across, pixels / (std::int64_t{width} * height));
  mc::Scan scan;
  scan.width = across * width;
  scan.height = static_cast<int>((count + across - 1) / across) * height;
  mc::SimulationOptions options;
  options.tally_memory = 0;
  options.scratch_folder = folder.string();
  mc::SimulationResult result = mc::empty_result(scan, options);
  const auto nobody = [](const std::string&) {};
  workflow::Checkpoint checkpoint({}, folder / "scale.exr", {{"what", "costs"}}, nobody, nobody);

  const auto of = [&](std::int64_t i) -> const mc::UnitTally& {
    return tallies[static_cast<std::size_t>(i) % tallies.size()];
  };
  const auto each = [&](const auto& work) {
    const double begin = processor_s();
    for (std::int64_t i = 0; i < count; ++i) work(i);
    return (processor_s() - begin) / static_cast<double>(count);
  };
  Handling out;
  std::vector<std::string> packed(tallies.size());
  out.pack_s = each([&](std::int64_t i) {
    packed[static_cast<std::size_t>(i) % tallies.size()] = mc::serialize(of(i));
  });
  for (const std::string& bytes : packed)
    out.bytes += static_cast<double>(bytes.size()) / static_cast<double>(packed.size());
  std::int64_t seen = 0;
  out.unpack_s = each([&](std::int64_t i) {
    seen += mc::deserialize(packed[static_cast<std::size_t>(i) % packed.size()]).balance.incident;
  });
  std::size_t added = 0;
  out.merge_s = each([&](std::int64_t i) {
    const int x = static_cast<int>(i % across) * width, y = static_cast<int>(i / across) * height;
    mc::merge(result, {x, y, x + width, y + height, 0, 1}, of(i));
    checkpoint.record(static_cast<std::size_t>(i), of(i));
    if ((added += of(i).pixels.size()) >= std::size_t{1} << 19) {
      result.release();
      added = 0;
    }
  });
  checkpoint.finish();
  if (seen == 0) fmt::print("no primaries\n");
  return out;
}

// Clock time: of an image whose tallies are in a scratch file, by one process.
double write_s_per_pixel(const fs::path& folder, int pixels_across) {
  mc::Scan scan = bench::view(view_nm, pixels_across);
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{3};
  options.tally_memory = 0;
  options.scratch_folder = folder.string();
  mc::SimulationResult result = mc::empty_result(scan, options);
  RandomStream random(3, 0, 0);
  for (auto& pixel : result.pixels.data()) pixel.primaries = pixel.hits = 100;
  for (auto& grid : result.counts)
    for (auto& c : grid.data()) {
      c.sum = static_cast<std::int64_t>(100 * random.uniform());
      c.squares = 2 * c.sum;
    }
  result.release();
  const fs::path file = folder / "scale_model.exr";
  timespec begin{}, end{};
  clock_gettime(CLOCK_MONOTONIC, &begin);
  io::write_image(file, mc::make_image_rows(result, scan));
  clock_gettime(CLOCK_MONOTONIC, &end);
  fs::remove(file);
  return (static_cast<double>(end.tv_sec - begin.tv_sec) +
          1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec)) /
         (static_cast<double>(pixels_across) * pixels_across);
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

limits::Table measure_costs(const fs::path& folder, bool quick) {
  limits::Table table{{"replay", "electrons", "pixels", "unit_s", "pack_s", "unpack_s", "merge_s",
                       "bytes", "write_s_per_pixel", "scene_s", "library_bytes", "library_pages"},
                      {}};
  for (int q = 0; q <= quantiles; ++q) table.columns.push_back(fmt::format("q{}_s", q));
  const double write_s = write_s_per_pixel(folder, quick ? 1024 : 4096);
  fmt::print("writing: {:.1f} ns per pixel\n", 1e9 * write_s);
  const mc::Scene scene(bench::mesa(bench::only_silicon()), bench::beam(1000),
                        bench::view(view_nm, side));
  const double scene_s = scene.summary().build_seconds;
  mc::FreshLibraries libraries;
  const auto add = [&](bool replay, std::int64_t electrons, Units units) {
    const Handling h = handle(units.tallies, folder, quick ? 100'000 : 1'000'000);
    std::vector<double> row{double(replay),
                            static_cast<double>(electrons),
                            static_cast<double>(units.tallies.front().pixels.size()),
                            mean(units.durations_s),
                            h.pack_s,
                            h.unpack_s,
                            h.merge_s,
                            h.bytes,
                            write_s,
                            scene_s,
                            0,
                            0};
    if (replay) {
      const mc::CascadeSettings settings{io::find_material("Si", "bench"),
                                         {},
                                         1000 + io::find_material("Si", "bench").barrier_ev,
                                         1};
      mc::SimulationOptions options;
      const auto library = libraries.library(settings, mc::library_size(options, electrons), 1, {});
      row[10] = static_cast<double>(library->bytes());
      row[11] = static_cast<double>(library->pages());
    }
    std::sort(units.durations_s.begin(), units.durations_s.end());
    for (int q = 0; q <= quantiles; ++q)
      row.push_back(units.durations_s[static_cast<std::size_t>(q) * (units.durations_s.size() - 1) /
                                      quantiles]);
    for (std::size_t i = 0; i < 8; ++i) fmt::print("{}={:.4g} ", table.columns[i], row[i]);
    fmt::print("\n");
    table.rows.push_back(std::move(row));
  };
  for (const std::int64_t electrons : {100, 1000}) {
    for (const std::int64_t primaries : {4096, 16384, 65536})
      add(false, electrons,
          simulate_directly(scene, electrons, static_cast<int>(primaries / electrons),
                            quick ? 3 : 40));
    add(true, electrons, simulate_by_replay(electrons, quick ? 64 : 256, libraries));
  }
  return table;
}

}  // namespace surf::scale
