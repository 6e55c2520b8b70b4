// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/profile/profile_library.h"

namespace surf::test {

/// A library of a box's design whose signals are signal(u, numbers), every half nanometre.
template <class Signal>
ProfileLibrary library_of(const ProfileBox& box, double first_u_nm, double last_u_nm,
                          const Signal& signal) {
  constexpr double step_nm = 0.5;
  const auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals;
  for (const ProfileNumbers& n : shapes) {
    signals.emplace_back();
    for (double u = first_u_nm; u <= last_u_nm; u += step_nm)
      signals.back().push_back(signal(u, n));
  }
  return {box, first_u_nm, step_nm, shapes, signals};
}

}  // namespace surf::test
