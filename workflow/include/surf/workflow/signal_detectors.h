// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/mc/transport/detector.h"

namespace surf::workflow {

/// What a simulation counts of a signal besides SE and BSE: nothing for these two; else one of the
/// quadrants or a detector in words (mc::parse_detectors). Throws UsageError naming `subject`.
std::vector<mc::Detector> detectors_of(const std::string& signal, const std::string& subject);

/// What a model of a signal learns besides SE and BSE: as `detectors_of`, but all quadrants for one
/// of them, so that one model serves all four.
std::vector<mc::Detector> taught_detectors(const std::string& signal, const std::string& subject);

/// The name of the channel that holds a signal.
std::string channel_of(const std::string& signal, const std::string& subject);

}  // namespace surf::workflow
