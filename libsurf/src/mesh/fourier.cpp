// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/fourier.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace surf {
namespace {

using Complex = std::complex<double>;
using Row = std::vector<Complex>;

Complex turn(double part) { return std::polar(1.0, 2 * std::numbers::pi * part); }

/// Forward transform in place, unscaled; the length must be a power of two.
void transform_power_of_two(Row& row) {
  const std::size_t n = row.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(row[i], row[j]);
  }
  for (std::size_t half = 1; half < n; half *= 2) {
    std::vector<Complex> factor(half);
    for (std::size_t k = 0; k < half; ++k) factor[k] = turn(-0.5 * double(k) / double(half));
    for (std::size_t i = 0; i < n; i += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex odd = row[i + half + k] * factor[k];
        row[i + half + k] = row[i + k] - odd;
        row[i + k] += odd;
      }
    }
  }
}

/// Forward transforms of one length, by Bluestein's convolution (1970) if the length is not a power
/// of two.
class Fourier {
 public:
  explicit Fourier(std::size_t n) : n_(n) {
    if (std::has_single_bit(n)) return;
    const std::size_t m = std::bit_ceil(2 * n - 1);
    kernel_.assign(m, 0);
    for (std::size_t k = 0; k < n; ++k) {
      // k^2 modulo 2 n keeps the angle exact for long rows.
      chirp_.push_back(turn(-0.5 * double(k * k % (2 * n)) / double(n)));
      kernel_[k] = kernel_[(m - k) % m] = std::conj(chirp_[k]);
    }
    transform_power_of_two(kernel_);
  }

  void operator()(Row& row) const {
    if (chirp_.empty()) return transform_power_of_two(row);
    const std::size_t m = kernel_.size();
    Row a(m, 0);
    for (std::size_t k = 0; k < n_; ++k) a[k] = row[k] * chirp_[k];
    transform_power_of_two(a);
    for (std::size_t k = 0; k < m; ++k) a[k] = std::conj(a[k] * kernel_[k]);
    transform_power_of_two(a);
    for (std::size_t k = 0; k < n_; ++k) row[k] = std::conj(a[k]) * chirp_[k] / double(m);
  }

 private:
  std::size_t n_;
  Row chirp_, kernel_;
};

/// Transforms the rows and returns the transpose. Applied twice, it transforms both axes.
Grid<Complex> transformed_transpose(const Grid<Complex>& in) {
  Grid<Complex> out(in.height(), in.width());
  const Fourier fourier(static_cast<std::size_t>(in.width()));
  Row row(static_cast<std::size_t>(in.width()));
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) row[static_cast<std::size_t>(x)] = in(x, y);
    fourier(row);
    for (int x = 0; x < in.width(); ++x) out(y, x) = row[static_cast<std::size_t>(x)];
  }
  return out;
}

double frequency(int index, int count) {
  return double(2 * index > count ? index - count : index) / count;
}

}  // namespace

Grid<double> filtered(const Grid<double>& grid, const std::function<double(double, double)>& gain) {
  Grid<Complex> work(grid.width(), grid.height());
  for (std::size_t i = 0; i < grid.size(); ++i) work.data()[i] = grid.data()[i];
  work = transformed_transpose(transformed_transpose(work));
  for (int y = 0; y < work.height(); ++y) {
    for (int x = 0; x < work.width(); ++x) {
      // The backward transform is the conjugate of the forward transform of the conjugate. The
      // final result is real.
      work(x, y) =
          std::conj(work(x, y)) * gain(frequency(x, work.width()), frequency(y, work.height()));
    }
  }
  work = transformed_transpose(transformed_transpose(work));
  Grid<double> result(grid.width(), grid.height());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    result.data()[i] = work.data()[i].real() / double(grid.size());
  }
  return result;
}

}  // namespace surf
