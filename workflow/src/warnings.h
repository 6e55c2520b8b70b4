// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "resolved_job.h"
#include "specimen_facts.h"

namespace surf::workflow {

/// What looks like a mistake before anything is simulated: sizes off by a unit, a scan beside the
/// specimen, numbers that cannot give what was asked.
std::vector<std::string> warn_before(const ResolvedJob& job, const SpecimenFacts& facts,
                                     const mc::Scan& scan);

/// What a result shows: nothing hit, lost electrons, an accuracy that was not reached.
std::vector<std::string> warn_after(const mc::SimulationResult& result,
                                    const mc::ResultSummary& summary);

}  // namespace surf::workflow
