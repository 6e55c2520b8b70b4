// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/noise_fields.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <mutex>
#include <numbers>
#include <vector>

namespace surf {
namespace {

struct Free {
  void operator()(void* p) const { fftwf_free(p); }
};
// Memory from FFTW: all buffers have the same alignment, so one plan fits all of them.
using Buffer = std::unique_ptr<std::complex<float>[], Free>;

Buffer buffer(std::size_t n) {
  return Buffer(static_cast<std::complex<float>*>(fftwf_malloc(n * sizeof(std::complex<float>))));
}

fftwf_complex* raw(std::complex<float>* p) { return reinterpret_cast<fftwf_complex*>(p); }

/// The next length with a fast transform.
int quick_length(int n) {
  for (int length = (n + 3) / 4 * 4;; length += 4) {
    int rest = length;
    for (const int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return length;
  }
}

/// What to take off a spectrum so that its parts above 0 add up to `sum`: the nearest spectrum that
/// belongs to a noise of variance 1 (projection onto the simplex, Duchi et al. 2008,
/// doi:10.1145/1390156.1390191). Estimated correlations need not belong to any noise, and cutting
/// off what is below 0 alone would add noise without correlation.
double surplus(std::vector<double> spectrum, double sum) {
  std::ranges::sort(spectrum, std::greater());
  double above = 0, less = 0;
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    above += spectrum[i];
    const double trial = (above - sum) / double(i + 1);
    if (spectrum[i] <= trial) break;
    less = trial;
  }
  return less;
}

std::mutex& planner() {
  static std::mutex mutex;  // FFTW plans in one thread at a time
  return mutex;
}

/// Two independent normal numbers (Box and Muller 1958).
std::complex<float> normal_pair(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.uniform()));
  const double angle = 2 * std::numbers::pi * random.uniform();
  return {static_cast<float>(radius * std::cos(angle)),
          static_cast<float>(radius * std::sin(angle))};
}

}  // namespace

double normal(RandomStream& random) { return double(normal_pair(random).real()); }

struct NoiseFields::Plan {
  int width, height;
  std::vector<float> amplitude;
  fftwf_plan backward;

  Plan(int w, int h, const NoiseCorrelation& c)
      : width(quick_length(w + c.reach())), height(quick_length(h + c.reach())),
        amplitude(count()) {
    const Buffer b = buffer(count());
    {
      const std::lock_guard lock(planner());
      backward = fftwf_plan_dft_2d(height, width, raw(b.get()), raw(b.get()), FFTW_BACKWARD,
                                   FFTW_ESTIMATE);
    }
    std::fill_n(b.get(), count(), std::complex<float>());
    const int r = c.reach();
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; ++dx)
        b[index((dx + width) % width, (dy + height) % height)] += float(c.at(dx, dy));
    fftwf_execute_dft(backward, raw(b.get()), raw(b.get()));
    std::vector<double> spectrum(count());
    for (std::size_t i = 0; i < count(); ++i) spectrum[i] = double(b[i].real());
    const double less = surplus(spectrum, double(count()));
    for (std::size_t i = 0; i < count(); ++i)
      amplitude[i] = float(std::sqrt(std::max(0.0, spectrum[i] - less) / double(count())));
  }
  ~Plan() {
    const std::lock_guard lock(planner());
    fftwf_destroy_plan(backward);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  std::size_t count() const { return std::size_t(width) * std::size_t(height); }
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
};

NoiseFields::NoiseFields(int width, int height, const NoiseCorrelation& correlation)
    : width_(width), height_(height) {
  if (!correlation.by_distance.empty()) plan_ = std::make_unique<Plan>(width, height, correlation);
}

NoiseFields::~NoiseFields() = default;

std::array<Grid<float>, 2> NoiseFields::pair(std::uint64_t seed, std::uint64_t number) const {
  std::array<Grid<float>, 2> out{Grid<float>(width_, height_), Grid<float>(width_, height_)};
  RandomStream random(seed, number, 0);
  if (!plan_) {
    for (std::size_t i = 0; i < out[0].size(); ++i) {
      const std::complex<float> n = normal_pair(random);
      out[0].data()[i] = n.real(), out[1].data()[i] = n.imag();
    }
    return out;
  }
  const Buffer b = buffer(plan_->count());
  for (std::size_t i = 0; i < plan_->count(); ++i) b[i] = plan_->amplitude[i] * normal_pair(random);
  fftwf_execute_dft(plan_->backward, raw(b.get()), raw(b.get()));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::complex<float> n = b[plan_->index(x, y)];
      out[0](x, y) = n.real(), out[1](x, y) = n.imag();
    }
  return out;
}

}  // namespace surf
