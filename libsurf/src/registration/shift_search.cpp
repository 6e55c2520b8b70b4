// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/shift_search.h"

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <mutex>

namespace surf {
namespace {

struct Free {
  void operator()(void* p) const { fftwf_free(p); }
};
// Memory from FFTW: all buffers have the same alignment, so one plan fits all of them.
using Reals = std::unique_ptr<float[], Free>;
using Spectrum = std::unique_ptr<std::complex<float>[], Free>;

Reals reals(std::size_t n) { return Reals(static_cast<float*>(fftwf_malloc(n * sizeof(float)))); }

Spectrum spectrum(std::size_t n) {
  return Spectrum(static_cast<std::complex<float>*>(fftwf_malloc(n * sizeof(std::complex<float>))));
}

fftwf_complex* raw(std::complex<float>* p) { return reinterpret_cast<fftwf_complex*>(p); }

/// The next length with a fast transform.
int quick_length(int n) {
  for (int length = (n + 7) / 8 * 8;; length += 8) {
    int rest = length;
    for (const int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

double count_of(const Grid<float>& mask) {
  double sum = 0;
  for (const float m : mask.data()) sum += m;
  return sum;
}

std::mutex& planner() {
  static std::mutex mutex;  // FFTW plans in one thread at a time
  return mutex;
}

}  // namespace

struct ShiftSearch::Plan {
  int width, height;
  std::size_t reals_count, spectrum_count;
  fftwf_plan forward, backward;
  std::array<Spectrum, 3> resting;  // of the mask, the values and their squares

  Plan(int w, int h)
      : width(w), height(h), reals_count(std::size_t(w) * std::size_t(h)),
        spectrum_count(std::size_t(w / 2 + 1) * std::size_t(h)) {
    const Reals r = reals(reals_count);
    const Spectrum s = spectrum(spectrum_count);
    const std::lock_guard lock(planner());
    forward = fftwf_plan_dft_r2c_2d(h, w, r.get(), raw(s.get()), FFTW_ESTIMATE);
    backward = fftwf_plan_dft_c2r_2d(h, w, raw(s.get()), r.get(), FFTW_ESTIMATE);
  }
  ~Plan() {
    const std::lock_guard lock(planner());
    fftwf_destroy_plan(forward);
    fftwf_destroy_plan(backward);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  std::array<Spectrum, 3> transforms(const MaskedGrid& image) const {
    std::array<Spectrum, 3> result;
    const Reals r = reals(reals_count);
    for (int power = 0; power < 3; ++power) {
      std::fill_n(r.get(), reals_count, 0.0F);
      for (int y = 0; y < image.values.height(); ++y)
        for (int x = 0; x < image.values.width(); ++x) {
          const float v = image.values(x, y);
          r[std::size_t(y) * std::size_t(width) + std::size_t(x)] = power == 0   ? image.mask(x, y)
                                                                    : power == 1 ? v
                                                                                 : v * v;
        }
      result[static_cast<std::size_t>(power)] = spectrum(spectrum_count);
      fftwf_execute_dft_r2c(forward, r.get(), raw(result[static_cast<std::size_t>(power)].get()));
    }
    return result;
  }

  /// Sum over x of f(x + shift) g(x).
  Reals correlated(const Spectrum& f, const Spectrum& g) const {
    const Spectrum product = spectrum(spectrum_count);
    const float scale = 1.0F / static_cast<float>(reals_count);
    for (std::size_t i = 0; i < spectrum_count; ++i) {
      const float a = f[i].real(), b = f[i].imag(), c = g[i].real() * scale,
                  d = -g[i].imag() * scale;
      product[i] = {a * c - b * d, a * d + b * c};
    }
    Reals result = reals(reals_count);
    fftwf_execute_dft_c2r(backward, raw(product.get()), result.get());
    return result;
  }
};

ShiftSearch::ShiftSearch(MaskedGrid resting, double least_share, const std::vector<Size>& sizes)
    : resting_(std::move(resting)), least_share_(least_share),
      resting_samples_(count_of(resting_.mask)) {
  for (const auto& [w, h] : sizes) {
    std::unique_ptr<Plan>& plan = plans_[size_for(w, h)];
    if (plan) continue;
    plan = std::make_unique<Plan>(size_for(w, h).first, size_for(w, h).second);
    plan->resting = plan->transforms(resting_);
  }
}

ShiftSearch::~ShiftSearch() = default;

/// Shifts by nearly a whole image alias with each other, but overlap too little to count.
ShiftSearch::Size ShiftSearch::size_for(int width, int height) const {
  const auto length = [&](int moving, int rest) {
    return quick_length(moving + rest -
                        static_cast<int>(0.5 * least_share_ * std::min(moving, rest)));
  };
  return {length(width, resting_.values.width()), length(height, resting_.values.height())};
}

std::vector<ShiftPeak> ShiftSearch::peaks(const MaskedGrid& moving, std::size_t count) const {
  const Plan& plan = *plans_.at(size_for(moving.values.width(), moving.values.height()));
  const std::array<Spectrum, 3> g = plan.transforms(moving);
  const auto& f = plan.resting;
  const Reals n = plan.correlated(f[0], g[0]), sf = plan.correlated(f[1], g[0]),
              sff = plan.correlated(f[2], g[0]), sg = plan.correlated(f[0], g[1]),
              sgg = plan.correlated(f[0], g[2]), sfg = plan.correlated(f[1], g[1]);
  const double least =
      std::max(16.0, least_share_ * std::min(resting_samples_, count_of(moving.mask)));
  Grid<double> evidence(plan.width, plan.height), correlation(plan.width, plan.height);
  for (std::size_t i = 0; i < plan.reals_count; ++i) {
    const double samples = n[i];
    if (samples < least) continue;
    const double ff = sff[i] - double(sf[i]) * sf[i] / samples,
                 gg = sgg[i] - double(sg[i]) * sg[i] / samples;
    // Values have about unit variance. Below this limit there is hardly any structure, or only
    // rounding.
    if (!(ff > 1e-3 * samples && gg > 1e-3 * samples)) continue;
    const double r = (sfg[i] - double(sf[i]) * sg[i] / samples) / std::sqrt(ff * gg);
    correlation.data()[i] = std::clamp(r, -1.0, 1.0);
    if (r > 0) evidence.data()[i] = -0.5 * samples * std::log1p(-std::min(r * r, 0.9999));
  }
  std::vector<ShiftPeak> found;
  const int w = plan.width, h = plan.height;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double here = evidence(x, y);
      if (!(here > 0)) continue;
      bool highest = true;
      for (int dy = -1; dy <= 1 && highest; ++dy)
        for (int dx = -1; dx <= 1 && highest; ++dx)
          highest = evidence((x + dx + w) % w, (y + dy + h) % h) <= here;
      if (!highest) continue;
      ShiftPeak peak{x < resting_.values.width() ? x : x - w,
                     y < resting_.values.height() ? y : y - h, correlation(x, y),
                     n[std::size_t(y) * std::size_t(w) + std::size_t(x)], here};
      found.push_back(peak);
    }
  const std::size_t kept = std::min(count, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                    [](const ShiftPeak& a, const ShiftPeak& b) {
                      if (a.evidence != b.evidence) return a.evidence > b.evidence;
                      return a.y != b.y ? a.y < b.y : a.x < b.x;
                    });
  found.resize(kept);
  return found;
}

}  // namespace surf
