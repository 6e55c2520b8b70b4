// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/film_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "model_input.h"
#include "padded_field.h"
#include "surf/core/error.h"

namespace surf {
namespace {

/// A polynomial in the cosine at a slope, and its derivatives by the slopes along x and y.
struct AtSlope {
  double value, by_x, by_y;
};

AtSlope at_slope(const std::array<double, 3>& p, double slope_x, double slope_y) {
  const double c = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y),
               by_cosine = p[1] + 2 * p[2] * c, per_slope = -by_cosine * c * c * c;
  return {p[0] + c * (p[1] + c * p[2]), per_slope * slope_x, per_slope * slope_y};
}

/// The relative change of a channel, and its derivatives, on all samples.
struct Change {
  Grid<double> value, by_x, by_y;

  Change(const std::array<double, 3>& p, const PaddedField& field)
      : value(field.width(), field.height()), by_x(value), by_y(value) {
    for (int y = 0; y < field.height(); ++y)
      for (int x = 0; x < field.width(); ++x) {
        const AtSlope at = at_slope(p, field.slope_x(x, y), field.slope_y(x, y));
        value(x, y) = at.value, by_x(x, y) = at.by_x, by_y(x, y) = at.by_y;
      }
  }
};

Grid<double> product(const Grid<double>& a, const Grid<double>& b) {
  Grid<double> out = a;
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] *= b.data()[i];
  return out;
}

class FilmLinearization final : public Linearization {
 public:
  FilmLinearization(std::unique_ptr<Linearization> model, const FilmEffect& film,
                    const HeightField& field, Edge edge)
      : model_(std::move(model)), field_(field, 1, edge), images_(model_->images()) {
    for (const auto& per_nm : film.per_nm) changes_.emplace_back(per_nm, field_);
    for (std::size_t c = 0; c < changes_.size(); ++c)
      images_.push_back(product(images_[c], changes_[c].value));
  }
  const ModelImages& images() const override { return images_; }

  Grid<double> gradient(const ModelImages& weights) const override {
    check_weights(weights, images_.size(), images_.front());
    ModelImages plain(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(half()));
    Grid<double> by_x = field_.none(), by_y = by_x;
    for (std::size_t c = 0; c < half(); ++c) {
      const Grid<double>& w = weights[half() + c];
      const Change& change = changes_[c];
      for (int y = 0; y < field_.height(); ++y)
        for (int x = 0; x < field_.width(); ++x) {
          plain[c](x, y) += w(x, y) * change.value(x, y);
          field_.at(by_x, x, y) += w(x, y) * images_[c](x, y) * change.by_x(x, y);
          field_.at(by_y, x, y) += w(x, y) * images_[c](x, y) * change.by_y(x, y);
        }
    }
    Grid<double> out = model_->gradient(plain);
    const Grid<double> by_slopes = field_.fold(field_.none(), by_x, by_y);
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += by_slopes.data()[i];
    return out;
  }

  ModelImages change(const Grid<double>& dz_nm) const override {
    ModelImages out = model_->change(dz_nm);
    const PaddedField dz = field_.like(dz_nm);
    for (std::size_t c = 0; c < half(); ++c) {
      const Change& change = changes_[c];
      out.push_back(product(out[c], change.value));
      for (int y = 0; y < field_.height(); ++y)
        for (int x = 0; x < field_.width(); ++x)
          out.back()(x, y) += images_[c](x, y) * (change.by_x(x, y) * dz.slope_x(x, y) +
                                                  change.by_y(x, y) * dz.slope_y(x, y));
    }
    return out;
  }

 private:
  std::size_t half() const { return changes_.size(); }

  std::unique_ptr<Linearization> model_;
  PaddedField field_;
  std::vector<Change> changes_;
  ModelImages images_;
};

}  // namespace

std::array<double, 3> fit_film_effect(const std::vector<FilmPoint>& points) {
  Eigen::MatrixXd powers(points.size(), 3);
  Eigen::VectorXd changes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FilmPoint& p = points[i];
    if (!(p.standard_error > 0) || !std::isfinite(p.standard_error) || !std::isfinite(p.per_nm))
      throw InvalidInput("film", "a standard error of its effect is not above 0",
                         "Simulate more electrons");
    const auto row = static_cast<Eigen::Index>(i);
    powers.row(row) << 1, p.cosine, p.cosine * p.cosine;
    powers.row(row) /= p.standard_error;
    changes(row) = p.per_nm / p.standard_error;
  }
  const auto solver = powers.colPivHouseholderQr();
  if (solver.rank() < 3)
    throw InvalidInput("film", "its effect is known at fewer than three slopes",
                       "Give three or more");
  const Eigen::Vector3d fit = solver.solve(changes);
  return {fit(0), fit(1), fit(2)};
}

FilmModel::FilmModel(std::shared_ptr<const ImageModel> model, FilmEffect film)
    : model_(std::move(model)), film_(std::move(film)) {
  if (!model_ || film_.per_nm.size() != model_->channels().size())
    throw InvalidInput("film", "its effect is not known for each channel of the model",
                       "Give three numbers per channel");
  for (const auto& per_nm : film_.per_nm)
    if (!std::ranges::all_of(per_nm, [](double v) { return std::isfinite(v); }))
      throw InvalidInput("film", "its effect is not finite", "Give 0 for no effect");
  channels_ = model_->channels();
  for (const std::string& name : model_->channels()) channels_.push_back(name + ".film");
}

ModelImages FilmModel::predict(const HeightField& field, const ModelOptions& options) const {
  ModelImages images = model_->predict(field, options);
  const PaddedField padded(field, 1, options.edge);
  for (const auto& per_nm : film_.per_nm) {
    const std::size_t channel = images.size() - film_.per_nm.size();
    images.push_back(product(images[channel], Change(per_nm, padded).value));
  }
  return images;
}

std::unique_ptr<Linearization> FilmModel::linearize(const HeightField& field,
                                                    const ModelOptions& options) const {
  return std::make_unique<FilmLinearization>(model_->linearize(field, options), film_, field,
                                             options.edge);
}

}  // namespace surf
