// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model_input.h"
#include "surf/sem/image_model.h"

namespace surf {

/// A model whose images and derivatives an engine makes. `Kind` names its `Parameters` and has
///     static auto run(const Parameters&, double pitch_x_nm, double pitch_y_nm, const
///     ModelOptions&, work)
/// which gives work(engine), of an engine in the precision that the options ask for. Engines refer
/// to the parameters and have
///     ModelImages predict(z_nm), Grid<double> gradient(z_nm, weights), ModelImages change(z_nm,
///     dz_nm)
/// Derivatives make again what they need of the images: reading it from memory takes as long.
template <class Kind>
class EngineLinearization final : public Linearization {
 public:
  using Parameters = typename Kind::Parameters;

  EngineLinearization(std::shared_ptr<const Parameters> parameters, const HeightField& field,
                      const ModelOptions& options)
      : parameters_(std::move(parameters)), options_(options), z_nm_(field.z_nm),
        pitch_x_nm_(field.pitch_x_nm), pitch_y_nm_(field.pitch_y_nm) {
    images_ = Kind::run(*parameters_, pitch_x_nm_, pitch_y_nm_, options_,
                        [&](const auto& engine) { return engine.predict(z_nm_); });
    options_.watch = {};  // who watches may be gone when derivatives are asked for
  }

  const ModelImages& images() const override { return images_; }

  Grid<double> gradient(const ModelImages& weights) const override {
    check_weights(weights, images_.size(), z_nm_);
    return Kind::run(*parameters_, pitch_x_nm_, pitch_y_nm_, options_,
                     [&](const auto& engine) { return engine.gradient(z_nm_, weights); });
  }

  ModelImages change(const Grid<double>& dz_nm) const override {
    check_change(dz_nm, z_nm_);
    return Kind::run(*parameters_, pitch_x_nm_, pitch_y_nm_, options_,
                     [&](const auto& engine) { return engine.change(z_nm_, dz_nm); });
  }

 private:
  std::shared_ptr<const Parameters> parameters_;
  ModelOptions options_;
  Grid<double> z_nm_;
  double pitch_x_nm_, pitch_y_nm_;
  ModelImages images_;
};

template <class Kind>
class EngineModel final : public ImageModel {
 public:
  using Parameters = typename Kind::Parameters;

  EngineModel(const ModelScope& scope, std::vector<std::string> names, Parameters parameters)
      : scope_(scope), names_(std::move(names)),
        parameters_(std::make_shared<const Parameters>(std::move(parameters))) {}

  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return scope_; }

  ModelImages predict(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    ModelImages images = Kind::run(*parameters_, field.pitch_x_nm, field.pitch_y_nm, options,
                                   [&](const auto& engine) { return engine.predict(field.z_nm); });
    check_images(images, names_);
    return images;
  }

  std::unique_ptr<Linearization> linearize(const HeightField& field,
                                           const ModelOptions& options) const override {
    check_field(scope_, field);
    check_span(field);
    auto linear = std::make_unique<EngineLinearization<Kind>>(parameters_, field, options);
    check_images(linear->images(), names_);
    return linear;
  }

 private:
  ModelScope scope_;
  std::vector<std::string> names_;
  std::shared_ptr<const Parameters> parameters_;
};

}  // namespace surf
