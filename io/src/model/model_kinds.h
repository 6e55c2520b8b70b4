// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <variant>

#include "files/json_value.h"
#include "surf/sem/trained_model.h"

namespace surf::io {

using ModelParameters = decltype(TrainedModel::parameters);

/// How the parameters of one kind of model are stored in a file.
struct ModelKind {
  const char* name;
  bool (*is)(const ModelParameters& parameters);
  /// For parameters of this kind only.
  nlohmann::ordered_json (*write)(const ModelParameters& parameters);
  ModelParameters (*read)(const JsonValue& parameters);
};

// Each kind has its own source file. A new kind needs a file, a line here and a line in
// model_file.cpp.
extern const ModelKind facet_network_kind;
extern const ModelKind slope_model_kind;
extern const ModelKind filter_bank_kind;
extern const ModelKind stopping_point_kind;
extern const ModelKind diffusion_matrix_kind;

template <class Parameters>
bool holds(const ModelParameters& parameters) {
  return std::holds_alternative<Parameters>(parameters);
}

}  // namespace surf::io
