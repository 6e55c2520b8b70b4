// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "surf/workflow/chain_chart_job.h"

namespace surf::workflow {

// The format of stored points. `from_json` throws nlohmann's exceptions.
nlohmann::ordered_json to_json(const RegistrationPoint& point);
nlohmann::ordered_json to_json(const ReconstructionPoint& point);
void from_json(const nlohmann::ordered_json& json, RegistrationPoint& point);
void from_json(const nlohmann::ordered_json& json, ReconstructionPoint& point);

std::string registration_csv(const ChainChartSummary& summary);
std::string reconstruction_csv(const ChainChartSummary& summary);
std::string chain_json(const ChainChartJob& job, const ChainChartSummary& summary);

}  // namespace surf::workflow
