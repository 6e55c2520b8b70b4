// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "chain_steps.h"
#include "compare/compare_steps.h"
#include "surf/core/error.h"
#include "surf/core/sample_image.h"
#include "surf/registration/register_images.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf::workflow {
namespace {

constexpr double percent = 100;
constexpr std::size_t fewest_pixels = 64;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The image that the surface predicts, at the pixels of the real one.
PlacedImage predicted_at(const PlacedImage& image, const PlacedImage& simulated,
                         const Affine& to_surface) {
  PlacedImage out{image.placement(), Grid<double>(image.values.width(), image.values.height()),
                  Mask(image.values.width(), image.values.height())};
  for (int y = 0; y < out.values.height(); ++y)
    for (int x = 0; x < out.values.width(); ++x) {
      if (!image.is_valid(x, y)) continue;
      const double value = sample_image(simulated, to_surface(image.place_nm(x, y)));
      if (!std::isfinite(value)) continue;
      out.values(x, y) = value;
      out.valid(x, y) = 1;
    }
  return out;
}

struct Line {
  double gain = 0, offset = 0;
};

/// The line through (predicted, real) by iteratively reweighted least squares with Tukey's
/// biweight, so that changed places do not draw it.
Line fit_line(const PlacedImage& predicted, const PlacedImage& real) {
  constexpr int steps = 20;
  constexpr double tukey = 4.685, normal = 1.4826;
  std::vector<double> x, y, r;
  for (std::size_t i = 0; i < predicted.values.size(); ++i)
    if (predicted.valid.includes(i))
      x.push_back(predicted.values.data()[i]), y.push_back(real.values.data()[i]);
  Line line;
  std::vector<double> weight(x.size(), 1);
  for (int step = 0; step < steps; ++step) {
    double n = 0, sx = 0, sy = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      n += weight[i], sx += weight[i] * x[i], sy += weight[i] * y[i];
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += weight[i] * (x[i] - sx / n) * (x[i] - sx / n);
      xy += weight[i] * (x[i] - sx / n) * (y[i] - sy / n);
    }
    line.gain = xx > 0 ? xy / xx : 0;
    line.offset = (sy - line.gain * sx) / n;
    r.clear();
    for (std::size_t i = 0; i < x.size(); ++i)
      r.push_back(std::abs(y[i] - line.gain * x[i] - line.offset));
    const double scale = normal * median(r);
    if (!(scale > 0)) break;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double t = r[i] / (tukey * scale);
      weight[i] = t < 1 ? (1 - t * t) * (1 - t * t) : 0;
    }
  }
  return line;
}

/// How much values change across a pixel.
double slope(const PlacedImage& image, int x, int y) {
  const auto half = [&](int u, int v, int p, int q) {
    const auto inside = [&](int a, int b) {
      return a >= 0 && b >= 0 && a < image.values.width() && b < image.values.height() &&
             image.is_valid(a, b);
    };
    return inside(u, v) && inside(p, q) ? 0.5 * (image.values(u, v) - image.values(p, q)) : 0;
  };
  return std::hypot(half(x + 1, y, x - 1, y), half(x, y + 1, x, y - 1));
}

/// Contrast: the standard deviation of the values.
double contrast_of(const PlacedImage& image) {
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (image.valid.includes(i)) ++n, sum += image.values.data()[i];
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (image.valid.includes(i)) squares += std::pow(image.values.data()[i] - sum / n, 2);
  return n > 1 ? std::sqrt(squares / (n - 1)) : 0;
}

/// Standard deviations of the image's noise by its flat places; empty where it has none.
Grid<double> noise_of(const PlacedImage& image, const PlacedImage& fitted, CompareSummary& s) {
  try {
    const SemNoise noise = estimate_sem_noise(image).noise;
    Grid<double> out(image.values.width(), image.values.height());
    for (std::size_t i = 0; i < out.size(); ++i)
      out.data()[i] = std::sqrt(noise.variance(fitted.values.data()[i]));
    s.deviation_from = "flat places of the image";
    return out;
  } catch (const InvalidInput&) {  // it shows no flat places
    s.deviation_from = "the difference";
    return {};
  }
}

bool register_to_surface(const CompareJob& job, const PlacedImage& image, const Reporter& reporter,
                         CompareSummary& s) {
  begin(reporter, "registration");
  if (job.parameters.registered) return true;
  RegistrationOptions options;
  options.threads = job.threads;
  options.watch = reporter.watch();
  options.least_overlap = job.parameters.least_overlap;
  s.pose->registration = register_images(image, s.pose->simulated, options);
  s.pose->sem_to_afm = s.pose->registration->sem_to_afm;
  if (s.pose->registration->verdict == RegistrationVerdict::verified) return true;
  s.reasons.push_back(fmt::format("the SEM image could not be laid on the surface ({}: {})",
                                  name(s.pose->registration->verdict),
                                  s.pose->registration->reason));
  return false;
}

}  // namespace

bool difference_from_image(const CompareJob& job, const Reporter& reporter, CompareSummary& s) {
  const HeightField& surface = std::get<MeasuredSurface>(job.before).field;
  const PlacedImage& image = std::get<PlacedImage>(job.after);
  validate(surface, "surface before"), validate(image, "SEM image");
  const StoredModel model = model_of(job.model, image, reporter);
  s.unit = "%";
  s.pose.emplace();
  s.pose->simulated = simulated_view(surface, *model.model, image.pitch_x_nm, job.threads);
  if (!register_to_surface(job, image, reporter, s)) return false;
  PlacedImage predicted = predicted_at(image, s.pose->simulated, s.pose->sem_to_afm);
  const auto pixels = static_cast<std::size_t>(std::ranges::count(predicted.valid.data(), 1));
  if (pixels < fewest_pixels)
    throw InvalidInput("SEM image", "hardly any of its pixels lie on the surface",
                       "Give an image of the same place");
  const Line line = fit_line(predicted, image);
  s.gain = line.gain, s.offset = line.offset;
  for (double& v : predicted.values.data()) v = line.gain * v + line.offset;
  s.contrast = contrast_of(predicted);
  if (!(line.gain > 0 && s.contrast > 0)) {
    s.reasons.push_back(
        "the SEM image does not become brighter where the surface says so: is it "
        "of this place, signal and energy?");
    return false;
  }
  MeasuredDifference& m = s.difference;
  m.placement() = image.placement();
  m.valid = predicted.valid;
  m.difference = Grid<double>(image.values.width(), image.values.height());
  m.systematic = m.difference;
  m.deviation = noise_of(image, predicted, s);
  const double to_percent = percent / s.contrast;
  const double place_px = s.pose->registration && std::isfinite(s.pose->registration->stderr_px)
                              ? s.pose->registration->stderr_px
                              : 0;
  for (int y = 0; y < m.difference.height(); ++y)
    for (int x = 0; x < m.difference.width(); ++x) {
      if (!m.valid.includes(x, y)) continue;
      m.difference(x, y) = to_percent * (image.values(x, y) - predicted.values(x, y));
      m.systematic(x, y) = std::hypot(percent * job.parameters.model_error,
                                      to_percent * place_px * slope(predicted, x, y));
      if (!m.deviation.empty()) m.deviation(x, y) *= to_percent;
    }
  s.before = std::move(predicted);
  s.after = image;
  s.after.valid = s.before.valid;
  return true;
}

}  // namespace surf::workflow
