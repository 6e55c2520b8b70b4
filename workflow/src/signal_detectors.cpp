// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/signal_detectors.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/core/error.h"

namespace surf::workflow {
namespace {

bool is_quadrant(const std::string& signal, const std::vector<mc::Detector>& quadrants) {
  return std::ranges::find(quadrants, signal, &mc::Detector::name) != quadrants.end();
}

}  // namespace

std::vector<mc::Detector> detectors_of(const std::string& signal, const std::string& subject) {
  if (signal == "SE" || signal == "BSE") return {};
  for (const mc::Detector& quadrant : mc::parse_detectors("quadrants", subject))
    if (quadrant.name == signal) return {quadrant};
  const std::vector<mc::Detector> own = mc::parse_detectors(signal, subject);
  if (own.size() != 1)
    throw UsageError(subject, fmt::format("'{}' is not one detector", signal),
                     "Give SE, BSE, BSE-right, BSE-top, BSE-left, BSE-bottom or one detector as "
                     "'semsurf simulate --detector' takes it");
  return own;
}

std::vector<mc::Detector> taught_detectors(const std::string& signal, const std::string& subject) {
  std::vector<mc::Detector> quadrants = mc::parse_detectors("quadrants", subject);
  return is_quadrant(signal, quadrants) ? quadrants : detectors_of(signal, subject);
}

std::string channel_of(const std::string& signal, const std::string& subject) {
  const std::vector<mc::Detector> own = detectors_of(signal, subject);
  return own.empty() ? signal : own.front().name;
}

}  // namespace surf::workflow
