// SPDX-License-Identifier: GPL-3.0-or-later
// What others do, beside the reconstruction: shape from shading by Horn and by Leclerc and Bobick,
// and global optimisers on the reconstruction's objective, all from the eroded scan, on folders
// that `semsurf sample` made:
//   bench_baselines MODEL.json CHART.svg CHOSEN_ON FOLDER ... [--seconds S]
// Weights of shape from shading are those that suit the folder CHOSEN_ON best; it judges nothing
// but the optimisers, for which nothing is chosen.
// Tip, map, gains and noise are the true ones. Errors are rms in nm, less the mean, those of global
// optimisers with it; S (30) is what each of these has. Times are of one processor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "baselines/processor_time.h"
#include "baselines/shape_from_shading_horn.h"
#include "baselines/shape_from_shading_leclerc_bobick.h"
#include "baselines/small_scene.h"
#include "reconstruction/gauss_newton.h"
#include "reconstruction/initial_surface.h"
#include "sample_truth.h"
#include "surf/io/cache.h"
#include "surf/io/model/model_file.h"
#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/slope_table.h"

namespace {

using namespace surf;
using bench::HeightsSoFar;
using bench::HornOptions;
using bench::LeclercBobickOptions;
using bench::ShadedImage;

using bench::processor_seconds;

struct Off {
  double rms_nm = 0, plane_rms_nm = 0;
  double median_nm = 0;  ///< of distances from the median
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Less the mean, and less the best plane.
Off off(const Grid<double>& z, const Grid<double>& truth) {
  const int w = z.width(), h = z.height();
  double n = 0, sum = 0, squares = 0, by_x = 0, by_y = 0, xx = 0, yy = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double d = z(x, y) - truth(x, y), u = x - 0.5 * (w - 1), v = y - 0.5 * (h - 1);
      ++n, sum += d, squares += d * d, by_x += u * d, by_y += v * d, xx += u * u, yy += v * v;
    }
  const double rest = squares - sum * sum / n;
  std::vector<double> distances(z.size());
  std::ranges::transform(z.data(), truth.data(), distances.begin(), std::minus<>());
  const double middle = median(distances);
  for (double& d : distances) d = std::abs(d - middle);
  return {std::sqrt(rest / n),
          std::sqrt(std::max(0.0, rest - by_x * by_x / xx - by_y * by_y / yy) / n),
          median(distances)};
}

struct Scene {
  std::string title;
  workflow::SampleTruth sample;
  ShadedImage image;
  ShadedImage own;  ///< made of the truth by the reflectance map, without noise
  Grid<double> start;
};

/// By central differences.
Grid<double> shaded(const Grid<double>& z, double pitch_nm, const bench::ReflectanceMap& map) {
  const int w = z.width(), h = z.height();
  Grid<double> out(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int l = std::max(x - 1, 0), r = std::min(x + 1, w - 1), b = std::max(y - 1, 0),
                t = std::min(y + 1, h - 1);
      out(x, y) = map.at((z(r, y) - z(l, y)) / ((r - l) * pitch_nm),
                         (z(x, t) - z(x, b)) / ((t - b) * pitch_nm))
                      .r;
    }
  return out;
}

/// The slope model of the sample's material and energy, two planes.
SlopeModelParameters slopes_of(const workflow::SampleTruth& s) {
  workflow::SlopeTableOptions options;
  options.electrons = 60'000;
  workflow::CachedLibraries libraries(io::cache_folder(""));
  return workflow::to_slope_model(workflow::make_slope_table(io::find_material(s.material, "bench"),
                                                             s.energy_ev, options, &libraries));
}

Scene read(const std::string& folder, const std::shared_ptr<const ImageModel>& model) {
  workflow::SampleTruth s = workflow::read_sample(folder);
  workflow::give_model(s, model);
  static const SlopeModelParameters slopes = slopes_of(s);
  std::vector<double> gains;
  for (const SlopeChannel& channel : slopes.channels)
    for (std::size_t c = 0; c < model->channels().size(); ++c)
      if (model->channels()[c] == channel.name) gains.push_back(s.sem.gains[c]);
  const bench::ReflectanceMap map = bench::reflectance_of(slopes, gains, s.sem.offset);
  const double pitch = s.sem.image.pitch_x_nm;
  ShadedImage image{s.sem.image.values, pitch, map}, own = image;
  for (double& v : image.relative.data()) v /= map.level_ground();
  own.relative = shaded(s.truth.z_nm, pitch, map);
  Grid<double> start =
      reconstruction::on_frame(reconstruction::eroded(s.afm, 0),
                               reconstruction::frame_of(nullptr, &s.sem, 0), s.sem.sem_to_afm);
  return {std::filesystem::path(folder).filename().string(), std::move(s), std::move(image),
          std::move(own), std::move(start)};
}

/// Error against time. The clock stands while errors are computed.
struct Curve {
  explicit Curve(const Grid<double>& true_nm) : truth(true_nm) {}
  void add(const Grid<double>& z) {
    const double asked = processor_seconds();
    const Off o = off(z, truth);
    seconds.push_back(asked - begin);
    rms_nm.push_back(o.rms_nm);
    last = o;
    begin += processor_seconds() - asked;
  }
  io::PlotSeries series(const std::string& name) const {
    return {name, seconds, rms_nm, {}, io::PlotStyle::line_points};
  }
  const Grid<double>& truth;
  double begin = processor_seconds();
  std::vector<double> seconds, rms_nm;
  Off last;
};

void print_row(const std::string& name, const Off& o, double seconds) {
  fmt::print("  {:28} {:7.2f} {:7.2f} {:7.2f} nm {:8.2f} s\n", name, o.rms_nm, o.plane_rms_nm,
             o.median_nm, seconds);
}

/// Tries all combinations on one scene and keeps the best.
HornOptions choose_horn(const Scene& s) {
  HornOptions best;
  double least = HUGE_VAL;
  for (const int levels : {1, 4})
    for (const double integrability : {0.3, 3.0})
      for (const double last : {0.1, 0.01, 0.001}) {
        const HornOptions o{levels, 0.3, last, integrability};
        const Off found = off(bench::shape_by_horn(s.image, s.start, o), s.sample.truth.z_nm);
        fmt::print("    Horn {} levels, integrability {}, smoothness to {}: {:.2f} nm\n", levels,
                   integrability, last, found.rms_nm);
        if (found.rms_nm < least) least = found.rms_nm, best = o;
      }
  return best;
}

LeclercBobickOptions choose_leclerc_bobick(const Scene& s) {
  LeclercBobickOptions best;
  double least = HUGE_VAL;
  for (const int levels : {1, 4})
    for (const double first : {1.0, 0.5, 0.1})
      for (const double last : {0.1, 0.01, 0.001}) {
        const LeclercBobickOptions o{levels, first, last};
        const Off found =
            off(bench::shape_by_leclerc_bobick(s.image, s.start, o), s.sample.truth.z_nm);
        fmt::print("    Leclerc and Bobick {} levels, lambda {} to {}: {:.2f} nm\n", levels, first,
                   last, found.rms_nm);
        if (found.rms_nm < least) least = found.rms_nm, best = o;
      }
  return best;
}

/// Begins at a surface, and notes when which scale ended.
class Journal final : public ReconstructionJournal {
 public:
  Journal(const Scene& s, Curve& curve, bool begins) : scene_(s), curve_(curve), begins_(begins) {}
  std::optional<ReconstructionState> found() override {
    if (!begins_) return {};
    ReconstructionState state;
    state.surface = scene_.sample.truth;
    state.surface.z_nm = scene_.start;
    state.gains = scene_.sample.sem.gains;
    state.offset = scene_.sample.sem.offset;
    return state;
  }
  void keep(const ReconstructionState& state) override {
    const Grid<double>& truth = curve_.truth;
    const int margin = (state.surface.z_nm.width() - truth.width()) / 2;
    curve_.add(
        reconstruction::cut_out(state.surface.z_nm, margin, margin, truth.width(), truth.height()));
  }

 private:
  const Scene& scene_;
  Curve& curve_;
  bool begins_;
};

io::PlotPanel compare(const Scene& s, const HornOptions& horn,
                      const LeclercBobickOptions& leclerc_bobick) {
  const Grid<double>& truth = s.sample.truth.z_nm;
  const Off start = off(s.start, truth);
  io::PlotPanel panel;
  panel.title = s.title;
  panel.x = {"time of a processor (s)", true, {}};
  panel.y = {"root-mean-square error (nm)", true, {}};
  panel.references = {{io::PlotDirection::horizontal, start.rms_nm, "the start: eroded scan"}};
  const auto run = [&](const std::string& name, bool drawn, const auto& work) {
    Curve curve(truth);
    work(curve);
    print_row(name, curve.last, curve.seconds.back());
    if (drawn) panel.series.push_back(curve.series(name));
  };
  const auto watched = [](Curve& c) { return [&c](const Grid<double>& z) { c.add(z); }; };
  fmt::print("{}: rms less the mean, less a plane, median; time\n", s.title);
  print_row("the start: eroded scan", start, 0);
  run("Horn", true, [&](Curve& c) { bench::shape_by_horn(s.image, s.start, horn, watched(c)); });
  run("Leclerc and Bobick", true, [&](Curve& c) {
    bench::shape_by_leclerc_bobick(s.image, s.start, leclerc_bobick, watched(c));
  });
  // Of these images nothing but the method is to blame.
  run("Horn, image by its own map", false, [&](Curve& c) {
    bench::shape_by_horn(s.own, s.start, {1, 0.1, 1e-3, 0.03}, watched(c));
  });
  run("Leclerc and Bobick, likewise", false, [&](Curve& c) {
    bench::shape_by_leclerc_bobick(s.own, s.start, {1, 0.1, 1e-3}, watched(c));
  });
  ReconstructionOptions options;
  options.uncertainty = options.refine_calibration = false;
  options.threads = 1;
  run("ours, SEM image alone", true, [&](Curve& c) {
    Journal journal(s, c, true);
    reconstruct(nullptr, &s.sample.sem, options, &journal);
  });
  run("ours, scan alone", false, [&](Curve& c) {
    c.add(reconstruction::on_frame(reconstruct(&s.sample.afm, nullptr, options).surface,
                                   reconstruction::frame_of(nullptr, &s.sample.sem, 0),
                                   s.sample.sem.sem_to_afm));
  });
  run("ours, both images", true, [&](Curve& c) {
    Journal journal(s, c, false);
    reconstruct(&s.sample.afm, &s.sample.sem, options, &journal);
  });
  return panel;
}

void print_optimiser(const std::string& name, double objective, double rms_nm, double seconds,
                     std::int64_t objectives) {
  fmt::print("  {:14} objective {:9.1f}, rms {:6.2f} nm after {:7.3f} s; {} objectives in all\n",
             name, objective, rms_nm, seconds, objectives);
}

/// Gauss-Newton on all heights. Each point is a run of its own of so many iterations.
void run_gauss_newton(const bench::SmallScene& small, io::PlotPanel& panel) {
  constexpr int most = 60;
  io::PlotSeries series{"Gauss-Newton, heights", {}, {}, {}, io::PlotStyle::line_points};
  for (int iterations = 1; iterations <= most; ++iterations) {
    reconstruction::Unknowns at = small.start;
    reconstruction::DescentOptions o;
    o.iterations = iterations;
    o.threads = 1;
    o.tolerance = 1e-2;
    const double begin = processor_seconds();
    const reconstruction::DescentReport report =
        reconstruction::gauss_newton(small.objective, at, o);
    series.x.push_back(processor_seconds() - begin);
    series.y.push_back(small.off_nm(at.z_nm.data()));
    if (report.ended != "converged" && iterations < most) continue;
    print_optimiser(series.name, small.objective.evaluate(at).value(), series.y.back(),
                    series.x.back(), report.evaluations);
    break;
  }
  panel.series.push_back(std::move(series));
}

io::PlotPanel compare_global(const Scene& s, int side, int spacing, double seconds) {
  using bench::GlobalOptimiser;
  const bench::SmallScene small = bench::small_scene(s.sample, side);
  const bench::HeightBox box = bench::box_of(small, spacing);
  const bench::BoxProblem& problem = box.problem;
  const auto off_nm = [&](const std::vector<double>& at) {
    return small.off_nm(box.heights_nm(at));
  };
  io::PlotPanel panel;
  panel.title = fmt::format("{}, {} x {} pixels, {} {}", s.title, side, side, problem.start.size(),
                            spacing == 0 ? "heights" : "splines");
  panel.x = {"time of a processor (s)", true, {}};
  panel.y = {"root-mean-square error (nm)", true, {}};
  panel.references = {
      {io::PlotDirection::horizontal, off_nm(problem.start), "the start: eroded scan"}};
  fmt::print("{}; numbers may go {:.0f} nm either way\n", panel.title,
             problem.high[0] - problem.start[0]);
  print_optimiser("the start", problem.value(problem.start.data(), nullptr), off_nm(problem.start),
                  0, 1);
  run_gauss_newton(small, panel);
  for (const GlobalOptimiser optimiser :
       {GlobalOptimiser::mlsl, GlobalOptimiser::crs2, GlobalOptimiser::isres,
        GlobalOptimiser::direct_l, GlobalOptimiser::esch}) {
    const bench::GlobalRun run = bench::minimise(optimiser, problem, seconds, 1);
    io::PlotSeries series{bench::name(optimiser), {}, {}, {}, io::PlotStyle::line};
    for (const bench::BestSoFar& best : run.history) {
      series.x.push_back(std::max(best.seconds, 1e-3));
      series.y.push_back(off_nm(best.at));
    }
    const bench::BestSoFar& last = run.history.back();
    print_optimiser(series.name, last.value, series.y.back(), last.seconds, run.evaluations);
    series.x.push_back(std::max(seconds, series.x.back()));
    series.y.push_back(series.y.back());
    panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words;
  double seconds = 30;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--seconds" && i + 1 < argc) seconds = std::atof(argv[++i]);
    else words.emplace_back(argv[i]);
  }
  if (words.size() < 4) {
    fmt::print(stderr, "bench_baselines MODEL.json CHART.svg CHOSEN_ON FOLDER ... [--seconds S]\n");
    return 2;
  }
  io::check_plot_target(words[1]);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto model = make_model(io::read_model(words[0]));
  const Scene chosen_on = read(words[2], model);
  const HornOptions horn = choose_horn(chosen_on);
  const LeclercBobickOptions leclerc_bobick = choose_leclerc_bobick(chosen_on);
  fmt::print(
      "chosen on {}: Horn, {} levels, integrability {}, smoothness {} to {}; Leclerc and Bobick, "
      "{} levels, lambda {} to {}\n",
      chosen_on.title, horn.levels, horn.integrability, horn.first_smoothness, horn.last_smoothness,
      leclerc_bobick.levels, leclerc_bobick.first_lambda, leclerc_bobick.last_lambda);
  compare(chosen_on, horn, leclerc_bobick);
  io::Plot plot;
  plot.title = "Reconstruction and what others do, from the same start";
  for (std::size_t i = 3; i < words.size(); ++i) {
    const Scene s = read(words[i], model);
    plot.panels.push_back(compare(s, horn, leclerc_bobick));
  }
  for (const auto& [side, spacing] : {std::pair{12, 4}, std::pair{12, 0}, std::pair{24, 0}})
    plot.panels.push_back(compare_global(chosen_on, side, spacing, seconds));
  plot.columns = 3;
  // One legend for each row, at its end, where there is room.
  for (std::size_t i = 0; i < plot.panels.size(); ++i)
    plot.panels[i].legend = i % 3 == 2 || i + 1 == plot.panels.size();
  io::write_plot(words[1], plot);
  return 0;
}
