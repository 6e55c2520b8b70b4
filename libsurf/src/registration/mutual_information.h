// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/core/progress.h"
#include "surf/registration/register_images.h"

namespace surf {

/// The width of histogram bins for a sample (thesis, appendix F): 2 IQR N^-1/3, or 3.49 sigma
/// N^-1/3. If half of the values are equal, so that the first width is 0, the second is used. 0 if
/// all values are equal.
double bin_width(std::vector<double> values, BinRule rule);

/// Mutual information of two samples of intensities in pairs, in nats, as in appendix F (with the
/// minus sign that its first formula lacks). It comes from a histogram, or from densities that are
/// estimated from the samples of even index by Gaussian windows and averaged over those of odd
/// index. The mutual information of samples of one colour is 0.
class JointHistogram {
 public:
  /// Chooses bins over the ranges of `a` and `b`; the rule gives their number, 2 to 128 for each.
  JointHistogram(const std::vector<double>& a, const std::vector<double>& b,
                 const MutualInformationOptions& options);

  int bin_a(double value) const { return a_.bin(value); }
  int bin_b(double value) const { return b_.bin(value); }
  void clear();
  void add(int a, int b, double weight) { count(a, b) += weight; }
  /// For Parzen's estimate: adds a pair that the densities are averaged over.
  void ask(int a, int b) { asked(a, b) += 1; }
  double information() const;

 private:
  struct Axis {
    double least = 0, width = 1, window_bins = 0;
    int count = 1;
    int bin(double value) const;
  };
  static Axis axis_for(const std::vector<double>& values, const MutualInformationOptions& options);

  double& count(int a, int b) {
    return counts_[static_cast<std::size_t>(a) * static_cast<std::size_t>(b_.count) +
                   static_cast<std::size_t>(b)];
  }
  double& asked(int a, int b) {
    return asked_[static_cast<std::size_t>(a) * static_cast<std::size_t>(b_.count) +
                  static_cast<std::size_t>(b)];
  }

  bool parzen_;
  Axis a_, b_;
  std::vector<double> counts_, asked_;
};

/// Mutual information of both images of a level in their overlap, as a function of the corners.
class MutualInformation {
 public:
  MutualInformation(const BlurLevel& level, const MutualInformationOptions& options);

  /// 0 if fewer than 24 samples overlap. Not thread-safe.
  double operator()(const ThreePointMap& corners);

 private:
  const BlurLevel& level_;
  MutualInformationOptions options_;
  JointHistogram histogram_;
  std::vector<int> sem_bins_;
  Grid<int> afm_bins_;  // bins of the AFM's samples, for partial volumes
};

struct InformationFit {
  ThreePointMap corners{};
  double information = 0;
  int evaluations = 0;
  /// Converged to 0.01 pixels (more for blurs above 5 pixels), and not at the limit of the allowed
  /// displacement.
  bool settled = false;
};

/// Maximises the mutual information from an initial map, by Powell's BOBYQA (NLopt). BOBYQA needs
/// no derivatives, and derivatives of histograms are meaningless.
InformationFit fit_information(const BlurLevel& level, const MutualInformationOptions& options,
                               const ThreePointMap& start, const Watch& watch);

/// The covariance of the corners, from the curvature of N times the mutual information, which is
/// the log-likelihood ratio against independence. N is reduced by `independent_share`.
std::array<double, 36> information_covariance(const BlurLevel& level,
                                              const MutualInformationOptions& options,
                                              const ThreePointMap& corners,
                                              double independent_share);

}  // namespace surf
