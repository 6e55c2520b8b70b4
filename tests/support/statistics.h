// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Tests with fixed seeds that would fail by chance with a probability of at most 1e-4 in all,
// however many comparisons a test makes: Bonferroni.

namespace surf::test {

inline constexpr double family_error = 1e-4;

/// The |z| that one of `comparisons` standard normal numbers exceeds with probability 1e-4.
inline double z_limit(std::size_t comparisons = 1) {
  double low = 0, high = 40;
  for (int i = 0; i < 100; ++i) {
    const double z = 0.5 * (low + high);
    const double two_sided = std::erfc(z / std::sqrt(2.0));
    (two_sided * static_cast<double>(comparisons) > family_error ? low : high) = z;
  }
  return high;
}

/// Chi-squared as a standard normal number (Wilson and Hilferty 1931).
inline double chi_squared_z(double chi_squared, double degrees) {
  const double v = 2.0 / (9.0 * degrees);
  return (std::cbrt(chi_squared / degrees) - (1.0 - v)) / std::sqrt(v);
}

/// Compares counts with expected counts; cells with fewer than 25 expected are pooled.
inline void expect_distributed(const std::vector<std::int64_t>& counts,
                               const std::vector<double>& expected, std::size_t comparisons = 1) {
  ASSERT_EQ(counts.size(), expected.size());
  double sum = 0, pool_expected = 0, pool_count = 0;
  int cells = 0;
  const auto add = [&](double count, double mean) {
    sum += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 25) {
      add(static_cast<double>(counts[i]), expected[i]);
    } else {
      pool_expected += expected[i];
      pool_count += static_cast<double>(counts[i]);
    }
  }
  if (pool_expected >= 25) add(pool_count, pool_expected);
  else EXPECT_LE(pool_count, 25 + 10 * std::sqrt(25.0)) << "too many in rare cells";
  ASSERT_GE(cells, 2);
  EXPECT_LT(chi_squared_z(sum, cells - 1), z_limit(comparisons))
      << "chi-squared " << sum << " with " << cells - 1 << " degrees of freedom";
}

/// Whether a mean with a standard error agrees with a truth.
inline void expect_mean(double mean, double standard_error, double truth,
                        std::size_t comparisons = 1, double tolerance = 0) {
  EXPECT_LE(std::fabs(mean - truth), z_limit(comparisons) * standard_error + tolerance)
      << mean << " +- " << standard_error << " against " << truth;
}

/// Mean and standard error of a sample.
class Sample {
 public:
  void add(double x) {
    ++n_;
    sum_ += x;
    squares_ += x * x;
  }
  double mean() const { return sum_ / n_; }
  double standard_error() const {
    return std::sqrt(std::fmax(0.0, squares_ / n_ - mean() * mean()) / (n_ - 1));
  }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

}  // namespace surf::test
