// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "resolved_job.h"
#include "specimen_facts.h"

namespace surf::workflow {

/// Warnings about likely mistakes before the simulation: sizes off by a unit, a scan beside the
/// specimen, numbers that cannot give the requested result.
std::vector<std::string> warn_before(const ResolvedJob& job, const SpecimenFacts& facts,
                                     const mc::Scan& scan);

/// Warnings about a result: nothing hit, lost electrons, an accuracy that was not reached.
std::vector<std::string> warn_after(const mc::SimulationResult& result,
                                    const mc::ResultSummary& summary);

}  // namespace surf::workflow
