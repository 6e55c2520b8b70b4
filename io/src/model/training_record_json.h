// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "files/json_value.h"
#include "surf/sem/trained_model.h"

namespace surf::io {

/// The origin of a model, as stored in its file.
nlohmann::ordered_json record_json(const TrainingRecord& record);
TrainingRecord record_of(const JsonValue& value);

}  // namespace surf::io
