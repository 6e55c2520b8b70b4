// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/argument.h"
#include "mesh/flat_field.h"
#include "mesh/fourier.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

// The finaliser of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014, doi:10.1145/2660193.2660195).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A standard normal number as a function of (seed, index), by Box and Muller.
double normal_number(std::uint64_t seed, std::uint64_t index) {
  constexpr std::uint64_t step = 0x9e3779b97f4a7c15u;
  const std::uint64_t start = mixed(seed + step);
  const auto uniform = [&](std::uint64_t i) {
    return (static_cast<double>(mixed(start + (i + 1) * step) >> 11) + 0.5) * 0x1p-53;
  };
  return std::sqrt(-2 * std::log(uniform(2 * index))) *
         std::cos(2 * std::numbers::pi * uniform(2 * index + 1));
}

/// The convolution of two equal kernels exp(-2 r^2 / L^2) is exp(-r^2 / L^2). At 3 L it is 2e-8.
std::vector<double> kernel(double correlation_nm, double pitch_nm) {
  const int reach = static_cast<int>(std::ceil(3 * correlation_nm / pitch_nm));
  std::vector<double> weights;
  for (int i = -reach; i <= reach; ++i) {
    const double r = i * pitch_nm / correlation_nm;
    weights.push_back(std::exp(-2 * r * r));
  }
  return weights;
}

/// Convolves every column periodically with the weights and returns the transpose. Applied twice,
/// it smooths along both axes, and the inner loop always runs along memory.
Grid<double> smoothed_transpose(const Grid<double>& in, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size() / 2);
  const int width = in.width();
  const int height = in.height();
  Grid<double> out(height, width);
  parallel_for(static_cast<std::size_t>(height), 0, [&](std::size_t unit, int) {
    const int y = static_cast<int>(unit);
    std::vector<double> sum(static_cast<std::size_t>(width), 0.0);
    for (int k = -reach; k <= reach; ++k) {
      const double* const row = &in(0, ((y + k) % height + height) % height);
      const double weight = weights[static_cast<std::size_t>(k + reach)];
      for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += weight * row[x];
    }
    for (int x = 0; x < width; ++x) out(y, x) = sum[static_cast<std::size_t>(x)];
  });
  return out;
}

double mean(const std::vector<double>& values, const std::function<double(double)>& f) {
  double sum = 0;
  for (const double value : values) sum += f(value);
  return sum / static_cast<double>(values.size());
}

void make_white(HeightField& field, std::uint64_t seed) {
  std::vector<double>& z = field.z_nm.data();
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = normal_number(seed, i);
}

void require_short(double correlation_nm, const HeightField& field) {
  const double period_nm = std::min(field.z_nm.width(), field.z_nm.height()) * field.pitch_x_nm;
  if (correlation_nm > 0.5 * period_nm) {
    throw UsageError(
        "correlation length",
        fmt::format("{} nm is more than half of the field's {} nm", correlation_nm, period_nm),
        "A periodic surface cannot vary that slowly: enlarge the field");
  }
}

/// Shifts the mean to 0 and scales to the root-mean-square height.
void set_rms(HeightField& field, double rms_nm) {
  std::vector<double>& smooth = field.z_nm.data();
  const double offset = mean(smooth, [](double v) { return v; });
  for (double& v : smooth) v -= offset;
  const double factor = rms_nm / std::sqrt(mean(smooth, [](double v) { return v * v; }));
  for (double& v : smooth) v *= factor;
}

/// The spectrum, interpolated between its points.
double density(const std::vector<SpectralDensity>& spectrum, double frequency_per_nm) {
  const auto above =
      std::ranges::lower_bound(spectrum, frequency_per_nm, {}, &SpectralDensity::frequency_per_nm);
  if (above == spectrum.end()) return 0;
  if (above->frequency_per_nm == frequency_per_nm) return above->density_nm4;
  if (above == spectrum.begin()) return 0;
  const SpectralDensity& a = *(above - 1);
  const double share =
      (frequency_per_nm - a.frequency_per_nm) / (above->frequency_per_nm - a.frequency_per_nm);
  return a.density_nm4 + share * (above->density_nm4 - a.density_nm4);
}

void require_spectrum(const std::vector<SpectralDensity>& spectrum) {
  if (spectrum.size() < 2) {
    throw UsageError("spectrum", fmt::format("it has {} points", spectrum.size()),
                     "Give two or more");
  }
  double last = 0;
  for (const SpectralDensity& point : spectrum) {
    require_positive(point.frequency_per_nm, "frequency of the spectrum");
    require_not_negative(point.density_nm4, "density of the spectrum");
    if (!(point.frequency_per_nm > last)) {
      throw UsageError("spectrum",
                       fmt::format("{} per nm follows {}", point.frequency_per_nm, last),
                       "Give rising frequencies");
    }
    last = point.frequency_per_nm;
  }
}

}  // namespace

HeightField make_rough(const FieldExtent& extent, double rms_nm, double correlation_nm,
                       std::uint64_t seed) {
  require_positive(rms_nm, "rms height");
  require_positive(correlation_nm, "correlation length");
  HeightField field = flat_field(extent);
  require_short(correlation_nm, field);
  make_white(field, seed);
  const std::vector<double> weights = kernel(correlation_nm, extent.pitch_nm);
  field.z_nm = smoothed_transpose(smoothed_transpose(field.z_nm, weights), weights);

  set_rms(field, rms_nm);
  return field;
}

HeightField make_self_affine(const FieldExtent& extent, double rms_nm, double correlation_nm,
                             double hurst, std::uint64_t seed) {
  require_positive(rms_nm, "rms height");
  require_positive(correlation_nm, "correlation length");
  if (!(hurst > 0 && hurst <= 1)) {
    throw UsageError("Hurst exponent", fmt::format("it is {}", hurst),
                     "Give a number above 0, at most 1");
  }
  HeightField field = flat_field(extent);
  require_short(correlation_nm, field);
  make_white(field, seed);
  const double scale = 2 * std::numbers::pi * correlation_nm / extent.pitch_nm;
  field.z_nm = filtered(field.z_nm, [&](double fx, double fy) {
    const double kl = scale * std::hypot(fx, fy);
    return std::pow(1 + kl * kl, -0.5 * (1 + hurst));
  });
  set_rms(field, rms_nm);
  return field;
}

HeightField make_rough_from_spectrum(const FieldExtent& extent,
                                     const std::vector<SpectralDensity>& spectrum,
                                     std::uint64_t seed) {
  require_spectrum(spectrum);
  HeightField field = flat_field(extent);
  make_white(field, seed);
  field.z_nm = filtered(field.z_nm, [&](double fx, double fy) {
    const double power = density(spectrum, std::hypot(fx, fy) / extent.pitch_nm);
    return std::sqrt(power) / extent.pitch_nm;
  });
  return field;
}

}  // namespace surf
