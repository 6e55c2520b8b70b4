// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace surf {

/// What a wall's signal depends on.
enum ProfileNumber { profile_width, profile_height, profile_angle, profile_top, profile_foot };
constexpr std::size_t profile_numbers = 5;
/// Width and height, nm; angle, degrees; radii of top and foot, nm.
using ProfileNumbers = std::array<double, profile_numbers>;

/// Where a library holds: about `middle`, within `half` on both sides; 0: this number is fixed.
struct ProfileBox {
  ProfileNumbers middle{}, half{};
};

/// Shapes to simulate for a library of this box: its middle, and points that fill it evenly
/// (Halton's sequence), enough for all linear and quadratic terms with `per_term` points each.
std::vector<ProfileNumbers> profile_design(const ProfileBox& box, double per_term = 2);

/// The middle shape's signal as it is known better than by the design's: its values and their
/// variances at the places of the signals.
struct FinerMiddle {
  std::vector<double> signal, variance;
};

/// How a blur of this normal deviation, in places, sums values: weights of a place itself, of the
/// next at each side, and so on; with both sides they sum to 1. 0: no blur.
std::vector<double> blur_weights(double deviation);

/// The signal across a wall, u nm from the middle of its flank, material at positive u, by a
/// quadratic function of the shape's numbers at each u, which is fitted to simulated signals.
class ProfileLibrary {
 public:
  struct Value {
    double value = 0, by_u = 0, by_u2 = 0;
    ProfileNumbers by_number{};
    /// Simulated places that the value is interpolated from, and their weights.
    std::array<std::size_t, 4> places{};
    std::array<double, 4> weights{};
  };

  /// `signals`: per shape the signal at u = first + k step; `middle`: if it is not empty, the level
  /// of all is its, and `signals` say how shapes differ. `blurred_by_nm`: signals are sums over
  /// neighbouring places with independent errors, by a normal distribution of this deviation.
  /// Throws InvalidInput for fewer shapes than terms, signals of different lengths, or values that
  /// are not finite.
  ProfileLibrary(ProfileBox box, double first_u_nm, double step_nm,
                 const std::vector<ProfileNumbers>& shapes,
                 const std::vector<std::vector<double>>& signals, const FinerMiddle& middle = {},
                 double blurred_by_nm = 0);

  /// Beyond the range of u the signal goes on as at its end.
  Value at(double u_nm, const ProfileNumbers& numbers) const;

  /// Variances of the values at the simulated places, by the simulations' noise and what no
  /// quadratic function fits, before they are blurred; those errors are independent.
  const std::vector<double>& variances() const { return variance_; }
  /// What a place's value has of its neighbours' values before they are blurred: of itself, of the
  /// next at each side, and so on.
  const std::vector<double>& blur() const { return blur_; }

  const ProfileBox& box() const { return box_; }
  double first_u_nm() const { return first_; }
  double step_nm() const { return step_; }
  double last_u_nm() const { return first_ + step_ * static_cast<double>(count_ - 1); }

 private:
  struct Term {
    double value;
    ProfileNumbers by_number;
  };
  std::vector<Term> terms(const ProfileNumbers& numbers) const;

  ProfileBox box_;
  double first_, step_;
  std::size_t count_ = 0, terms_ = 0;
  std::vector<std::size_t> free_;
  std::vector<double> coefficients_;  // of each u, its terms
  std::vector<double> variance_;      // of the fitted value, at each u, before it is blurred
  std::vector<double> blur_;
};

}  // namespace surf
