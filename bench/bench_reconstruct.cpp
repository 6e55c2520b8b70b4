// SPDX-License-Identifier: GPL-3.0-or-later
// How far reconstructions are off and what they cost, on folders that `semsurf sample` made:
//   bench_reconstruct MODEL.json FOLDER ... [--methods CHART.svg]
// Tip, map, noise and gains are the true ones, so that it is the reconstruction that is judged;
// `semsurf reconstruct --truth` judges the whole chain. With --methods the thesis's descents run
// beside Gauss-Newton, from the same start, and error is drawn against time, a point for each
// scale.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruction/initial_surface.h"
#include "reconstruction/objective.h"
#include "reconstruction/preconditioner.h"
#include "sample_truth.h"
#include "surf/io/model/model_file.h"
#include "surf/io/plot.h"

namespace {

using namespace surf;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double seconds(const Work& work) {
  double best = 1e300;
  for (int i = 0; i < 5; ++i) {
    const double begin = now();
    work();
    best = std::min(best, now() - begin);
  }
  return best;
}

using Scene = workflow::SampleTruth;

Scene read(const std::string& folder, const std::shared_ptr<const ImageModel>& model) {
  Scene s = workflow::read_sample(folder);
  workflow::give_model(s, model);
  return s;
}

double rms(const HeightField& surface, const HeightField& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < truth.z_nm.size(); ++i) {
    const double d = surface.z_nm.data()[i] - truth.z_nm.data()[i];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(truth.z_nm.size()));
}

/// The AFM-only reconstruction on the SEM's samples.
HeightField in_sem_frame(const HeightField& surface, const Scene& s) {
  const PlacedImage& i = s.sem.image;
  HeightField out = s.truth;
  out.z_nm = reconstruction::on_frame(
      surface, {i.values.width(), i.values.height(), i.pitch_x_nm, i.origin_x_nm, i.origin_y_nm},
      s.sem.sem_to_afm);
  return out;
}

void print_costs(const Scene& s) {
  using namespace reconstruction;
  const SurfaceFrame frame = frame_of(&s.afm, &s.sem, 12);
  Objective o{.prior = CurvaturePrior(frame.pitch_nm, 2e-3), .frame = frame};
  o.fit_map = o.fit_mixture = true;
  const HeightField outside = eroded(s.afm, 0);
  o.afm.emplace(s.afm, outside, frame, s.sem.sem_to_afm, 0);
  o.sem.emplace(s.sem, frame, 12, 12, 0);
  Unknowns at{
      on_frame(outside, frame, s.sem.sem_to_afm), s.sem.sem_to_afm, {s.sem.gains, s.sem.offset}};
  const Objective::State state = o.evaluate(at);
  const Step g = o.gradient(at, state);
  Preconditioner m(Preconditioner::usual_tile_px, 0);
  m.factor(o, at, state);
  const double value = seconds([&] { o.evaluate(at); }),
               gradient = seconds([&] { o.gradient(at, state); });
  const double product = seconds([&] { o.product(at, state, g); }),
               factor = seconds([&] { m.factor(o, at, state); });
  Preconditioner twice(Preconditioner::usual_tile_px, 0, Precision::double_always);
  const double double_factor = seconds([&] { twice.factor(o, at, state); });
  const Objective::Near near = o.near(at, state);
  const double sparse = seconds([&] { o.product(at, state, g, &near); }),
               made = seconds([&] { o.near(at, state); });
  const double model = seconds([&] { s.sem.model->predict(frame.field(at.z_nm)); });
  fmt::print(
      "  costs: objective {:.0f} ms, gradient {:.0f} ms, second derivative times a vector {:.0f} "
      "ms, sparse {:.0f} ms (made in {:.0f} ms), factor {:.0f} ms, "
      "its solution {:.0f} ms; the SEM model alone {:.0f} ms, {:.0f} samples\n",
      1e3 * value, 1e3 * gradient, 1e3 * product, 1e3 * sparse, 1e3 * made, 1e3 * factor,
      1e3 * seconds([&] { m.solve(g); }), 1e3 * model, 1.0 * static_cast<double>(at.z_nm.size()));
  fmt::print(
      "  in double precision: factor {:.0f} ms, its solution {:.0f} ms, {:.0f} MB in place of "
      "{:.0f}; "
      "{} of {} tiles need it\n",
      1e3 * double_factor, 1e3 * seconds([&] { twice.solve(g); }),
      1e-6 * static_cast<double>(twice.bytes()), 1e-6 * static_cast<double>(m.bytes()),
      m.double_tiles(), m.tiles());
}

/// When which scale ended, and how far its surface was off.
class Clock : public ReconstructionJournal {
 public:
  explicit Clock(const HeightField& truth) : truth_(truth), begin_(now()) {}
  std::optional<ReconstructionState> found() override { return {}; }
  void keep(const ReconstructionState& state) override {
    const double asked = now();
    const int margin = (state.surface.z_nm.width() - truth_.z_nm.width()) / 2;
    double sum = 0;
    for (int y = 0; y < truth_.z_nm.height(); ++y)
      for (int x = 0; x < truth_.z_nm.width(); ++x) {
        const double d = state.surface.z_nm(x + margin, y + margin) - truth_.z_nm(x, y);
        sum += d * d;
      }
    seconds.push_back(asked - begin_);
    rms_nm.push_back(std::sqrt(sum / static_cast<double>(truth_.z_nm.size())));
    begin_ += now() - asked;
  }
  std::vector<double> seconds, rms_nm;

 private:
  const HeightField& truth_;
  double begin_;
};

struct Run {
  Reconstruction result;
  double seconds = 0;
};

Run run(const Scene& s, bool afm, bool sem, const ReconstructionOptions& o,
        ReconstructionJournal* journal = nullptr) {
  const double begin = now();
  Run r{reconstruct(afm ? &s.afm : nullptr, sem ? &s.sem : nullptr, o, journal), 0};
  r.seconds = now() - begin;
  return r;
}

void print_run(const char* label, const Run& r, double error, double start, double floor) {
  int evaluations = 0, products = 0, iterations = 0;
  for (const ScaleReport& s : r.result.scales) {
    evaluations += s.evaluations;
    products += s.products;
    iterations += s.iterations;
  }
  fmt::print(
      "  {:<28} rms {:.2f} nm = {:.2f} floors, squares {:.3f} of the eroded scan's; {:.1f} s, {} "
      "iterations, {} objectives, {} "
      "products, {}\n",
      label, error, error / floor, error * error / (start * start), r.seconds, iterations,
      evaluations, products, r.result.scales.back().ended);
}

double judge(const std::string& folder, const std::shared_ptr<const ImageModel>& model,
             io::Plot* methods) {
  const Scene s = read(folder, model);
  ReconstructionOptions o;
  o.uncertainty = false;
  const double floor = noise_floor_nm(&s.afm, &s.sem, s.truth, o);
  const Run both = run(s, true, true, o), afm = run(s, true, false, o);
  const double start = rms(both.result.start, s.truth),
               alone = rms(in_sem_frame(afm.result.surface, s), s.truth);
  fmt::print(
      "{}\n  eroded scan rms {:.2f} nm; the floor, of noise and prior at the truth, {:.2f} nm\n",
      folder, start, floor);
  print_run("AFM alone", afm, alone, start, floor);
  print_run("AFM and SEM", both, rms(both.result.surface, s.truth), start, floor);
  o.double_precision = true;
  const Run twice = run(s, true, true, o);
  o.double_precision = false;
  print_run("in double precision", twice, rms(twice.result.surface, s.truth), start, floor);
  o.refine_calibration = false;
  const Run held = run(s, true, true, o);
  print_run("both, gains held", held, rms(held.result.surface, s.truth), start, floor);
  o.refine_calibration = true;
  if (methods) {
    io::PlotPanel panel;
    panel.title = std::filesystem::path(folder).filename().string();
    panel.x = {"time on this machine (s)", true, {}};
    panel.y = {"root-mean-square error (nm)", true, {}};
    panel.references = {{io::PlotDirection::horizontal, start, "eroded scan"},
                        {io::PlotDirection::horizontal, floor, "floor"}};
    for (const auto& [method, name] :
         {std::pair{ReconstructionMethod::gauss_newton, "Gauss-Newton"},
          std::pair{ReconstructionMethod::conjugate_gradients, "conjugate gradients (thesis)"},
          std::pair{ReconstructionMethod::lbfgs, "L-BFGS"}}) {
      o.method = method;
      Clock clock(s.truth);
      const Run r = run(s, true, true, o, &clock);
      print_run(name, r, rms(r.result.surface, s.truth), start, floor);
      panel.series.push_back({name, clock.seconds, clock.rms_nm, {}, io::PlotStyle::line_points});
    }
    methods->panels.push_back(std::move(panel));
  }
  o = {};
  const Run with = run(s, true, true, o);
  double one = 0, two = 0;
  const auto n = static_cast<double>(s.truth.z_nm.size());
  for (std::size_t i = 0; i < s.truth.z_nm.size(); ++i) {
    const double z = std::fabs(with.result.surface.z_nm.data()[i] - s.truth.z_nm.data()[i]) /
                     with.result.deviation_nm.data()[i];
    one += (z < 1) / n;
    two += (z < 2) / n;
  }
  fmt::print("  deviations: {:.2f} within one, {:.2f} within two; {:.1f} s with them\n", one, two,
             with.seconds);
  print_costs(s);
  return rms(both.result.surface, s.truth) / floor;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> folders;
  std::string chart;
  for (int i = 2; i < argc; ++i) {
    if (std::string(argv[i]) == "--methods" && i + 1 < argc) chart = argv[++i];
    else folders.emplace_back(argv[i]);
  }
  if (folders.empty()) {
    fmt::print(stderr, "bench_reconstruct MODEL.json FOLDER ... [--methods CHART.svg]\n");
    return 2;
  }
  if (!chart.empty()) io::check_plot_target(chart);
  fmt::print(
      "The thesis's ratios of squares (table 10-1): 0.114, 0.397, 0.414, 0.133, 0.049, in 3.5 to 6 "
      "hours\n");
  const auto model = surf::make_model(surf::io::read_model(argv[1]));
  io::Plot methods;
  double worst = 0;
  for (const std::string& folder : folders)
    worst = std::max(worst, judge(folder, model, chart.empty() ? nullptr : &methods));
  fmt::print("worst: {:.2f} floors\n", worst);
  if (!chart.empty()) io::write_plot(chart, methods);
  return 0;
}
