// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "physics/dielectric/shells.h"
#include "surf/mc/physics/full_penn.h"

namespace surf::mc {

/// For each loss of a grid the integral of ELF(q, w) dq / q up to a momentum, over x = q / sqrt(2
/// w): where a free electron at rest takes the loss, x is 1.
struct FullPenn::Table {
  explicit Table(const DielectricData& data);

  std::size_t rows() const { return losses.size(); }
  std::size_t cells() const { return edges.size() - 1; }
  std::size_t bytes() const {
    return (integral.size() + plasmon.size() + inner.size()) * sizeof(float);
  }

  Parts value(double loss, double momentum) const;

  /// The integral up to a momentum at a row.
  double up_to(std::size_t row, double momentum) const;

  /// (1 / pi) over m v^2 / 2, and the rest: density of 1 / lambda over ln w at a row, per bohr.
  double density(double energy, std::size_t row) const;

  DielectricData data;
  EnergyLossFunction elf;
  // Of gases by the logarithm of their plasma energy, from `first_log` in steps of `step_log`:
  // weight times plasma energy, and how much of it is of inner shells where enough is lost.
  double first_log = 0, step_log = 1;
  std::vector<float> weights;
  Shells shells;
  std::vector<double> losses;   // hartree, rising
  std::vector<double> widths;   // of ln w, that a row stands for
  std::vector<double> edges;    // of x
  std::vector<float> integral;  // [row][edge]
  std::vector<float> plasmon;   // [row][cell]: its share in the cell
  std::vector<float> inner;     // likewise that of inner shells
};

}  // namespace surf::mc
