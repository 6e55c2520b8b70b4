// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/core/progress.h"
#include "surf/registration/register_images.h"

namespace surf {

/// Width of histogram bins for a sample (thesis, appendix F): 2 IQR N^-1/3, or 3.49 sigma N^-1/3.
/// Where half the values are one, so that the first is 0, the second. 0 for values that are all
/// one.
double bin_width(std::vector<double> values, BinRule rule);

/// Mutual information of two samples of intensities in pairs, in nats, as appendix F has it (with
/// the minus sign that its first formula lacks): from a histogram, or with densities estimated from
/// the samples of even index by Gaussian windows and averaged over those of odd index. Samples of
/// one colour share nothing: 0.
class JointHistogram {
 public:
  /// Bins over all of `a` and all of `b`, as many as the rule gives, 2 to 128 for each.
  JointHistogram(const std::vector<double>& a, const std::vector<double>& b,
                 const MutualInformationOptions& options);

  int bin_a(double value) const { return a_.bin(value); }
  int bin_b(double value) const { return b_.bin(value); }
  void clear();
  void add(int a, int b, double weight) { count(a, b) += weight; }
  /// For Parzen's estimate: a pair that the densities are averaged over.
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

/// Mutual information of both images of a level where they overlap, as a function of the corners.
class MutualInformation {
 public:
  MutualInformation(const BlurLevel& level, const MutualInformationOptions& options);

  /// 0 where fewer than 24 samples overlap. Not from several threads at once.
  double operator()(const Corners& corners);

 private:
  const BlurLevel& level_;
  MutualInformationOptions options_;
  JointHistogram histogram_;
  std::vector<int> sem_bins_;
  Grid<int> afm_bins_;  // of the AFM's samples, for partial volumes
};

struct InformationFit {
  Corners corners{};
  double information = 0;
  int evaluations = 0;
  bool settled = false;  ///< to a hundredth of a pixel, and not at the limit of how far it may go
};

/// Largest mutual information from a start on, by Powell's BOBYQA (NLopt), which needs no
/// derivatives: those of histograms tell nothing.
InformationFit fit_information(const BlurLevel& level, const MutualInformationOptions& options,
                               const Corners& start, const Watch& watch);

/// Standard errors from the curvature of N times the mutual information, which is the
/// log-likelihood ratio against independence, with N less by what `independent_share` says of the
/// samples' residuals.
std::array<double, 36> information_covariance(const BlurLevel& level,
                                              const MutualInformationOptions& options,
                                              const Corners& corners, double independent_share);

}  // namespace surf
