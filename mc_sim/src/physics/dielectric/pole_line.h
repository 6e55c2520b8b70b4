// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

namespace surf::mc {

/// The losses that a loss w0 of light becomes at momenta q: w_q^2 = w0^2 + b q^2 + q^4 / 4 with b =
/// kF^2 / 3 of the electron gas whose plasma energy is w0. Atomic units. Along the line dq / (q
/// w_q) is the differential of -ln t / (2 w0), where t = (2 w0 w_q + b q^2 + 2 w0^2) / q^2.
class PoleLine {
 public:
  explicit PoleLine(double w0)
      : w0_(w0), fermi_(std::cbrt(0.75 * std::numbers::pi * w0 * w0)), b_(fermi_ * fermi_ / 3) {}

  double loss(double q) const { return loss_of_square(q * q); }
  double loss_of_square(double u) const { return std::sqrt(w0_ * w0_ + u * (b_ + 0.25 * u)); }
  /// dw / dq where the loss is w.
  double slope(double q, double w) const { return q * (b_ + 0.5 * q * q) / w; }
  /// The momentum of a loss, not below w0.
  double momentum(double w) const {
    return std::sqrt(2 * (std::sqrt(b_ * b_ + w * w - w0_ * w0_) - b_));
  }

  double log_t(double q) const {
    const double u = q * q;
    return std::log((2 * w0_ * (loss_of_square(u) + w0_) + b_ * u) / u);
  }
  double square_of_momentum(double log_t) const {
    const double t = std::exp(log_t), s = t - b_;
    return 4 * w0_ * w0_ * t / (s * s - w0_ * w0_);
  }
  /// The integral of dq / (q w_q).
  double integral(double first, double last) const {
    return (log_t(first) - log_t(last)) / (2 * w0_);
  }

  /// Whether a loss on the line is a plasmon's: from where single electrons of the gas can take
  /// loss and momentum it is theirs.
  bool is_collective(double q, double w) const { return w > q * (fermi_ + 0.5 * q); }

 private:
  double w0_, fermi_, b_;
};

}  // namespace surf::mc
