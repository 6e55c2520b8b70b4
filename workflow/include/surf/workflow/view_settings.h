// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/core/parameters.h"

namespace surf::workflow {

/// How further SEM images of the same place were taken. Lists have a value for each SEM image, the
/// first included, or one for each further image.
struct ViewSettings {
  std::vector<double> tilts_deg;     ///< of the beam; the first image's is 0
  std::vector<double> azimuths_deg;  ///< as in mc::Beam; none: 0
  std::vector<double> energies_ev;   ///< of the beam; none: as for the first image
  /// What each shows: SE, BSE or a detector, see `detectors_of`; none: as the first
  std::vector<std::string> signals;
  double tilt_error_deg = 0.5;  ///< standard error of tilts along x and y
};
void describe(ParameterVisitor& visit, ViewSettings& settings);

/// Of each further image.
struct ViewAngles {
  double tilt_deg = 0, azimuth_deg = 0, energy_ev = 0;
};
/// Throws UsageError for lists of other lengths, a first image that is tilted, and tilts out of
/// range. `energy_ev`: the first image's.
std::vector<ViewAngles> angles_of(const ViewSettings& settings, std::size_t views,
                                  double energy_ev);

/// What the first image shows: what its own option says, or a list that includes it.
std::string first_signal(const ViewSettings& settings, std::size_t views, const std::string& own);

/// What each further image shows; `first`: what the first one shows. Throws UsageError as
/// `angles_of`, and for a list that says otherwise of the first image.
std::vector<std::string> signals_of(const ViewSettings& settings, std::size_t views,
                                    const std::string& first);

/// The error of a list of another length.
[[noreturn]] void refuse_length(std::size_t given, std::size_t views, const std::string& subject);

/// What a list says of each further image; where it is empty, `otherwise`. Throws UsageError naming
/// `subject` for other lengths.
template <class T>
std::vector<T> for_each_view(const std::vector<T>& list, std::size_t views, const T& otherwise,
                             const std::string& subject) {
  if (list.empty()) return std::vector<T>(views, otherwise);
  if (list.size() == views) return list;
  if (list.size() == views + 1) return {list.begin() + 1, list.end()};
  refuse_length(list.size(), views, subject);
}

}  // namespace surf::workflow
