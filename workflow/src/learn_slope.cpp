// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "learners.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

// The forms are fixed functions of slope. Only the yields of a level surface are fitted, by least
// squares over all pixels, weighted by their standard errors.
Learnt learn(const Lesson& lesson, SlopeForm form) {
  SlopeModelParameters parameters;
  parameters.form = form;
  for (const std::string& channel : lesson.channels)
    parameters.channels.push_back({channel, 1, {}});
  const auto relative = make_slope_model(lesson.scope, parameters);
  std::vector<double> products(lesson.channels.size()), squares(lesson.channels.size());
  for (const TrainingImage& image : lesson.images) {
    const ModelImages shape =
        relative->predict(image.field, {image.edge, lesson.job.simulation.threads});
    for (std::size_t c = 0; c < products.size(); ++c) {
      for (std::size_t k = 0; k < shape[c].size(); ++k) {
        if (!image.used.empty() && !image.used.data()[k]) continue;
        const double error = image.standard_errors.empty() ? 1 : image.standard_errors[c].data()[k];
        const double f = shape[c].data()[k], weight = 1 / (error * error);
        products[c] += weight * f * image.images[c].data()[k];
        squares[c] += weight * f * f;
      }
    }
  }
  for (std::size_t c = 0; c < products.size(); ++c) {
    parameters.channels[c].flat_yield = squares[c] > 0 ? products[c] / squares[c] : 0;
    if (!(parameters.channels[c].flat_yield > 0))
      throw InvalidInput("training images",
                         fmt::format("channel {} holds no signal", lesson.channels[c]),
                         "Give images with a mean above 0");
  }
  return {parameters, 0, {}, {}};
}

template <SlopeForm form>
Learnt learn_form(const Lesson& lesson) {
  return learn(lesson, form);
}

}  // namespace

const Learner secant_learner{
    "secant", "1 / cos of the slope (Jones 1994)", {}, nullptr, learn_form<SlopeForm::secant>};
const Learner ikeuchi_exponential_learner{"ikeuchi-exponential",
                                          "exp(1 - cos) of the slope (Ikeuchi 1981)",
                                          {},
                                          nullptr,
                                          learn_form<SlopeForm::ikeuchi_exponential>};
const Learner ikeuchi_secant_learner{"ikeuchi-secant",
                                     "1 / cos of 0.8 times the slope (Ikeuchi 1981)",
                                     {},
                                     nullptr,
                                     learn_form<SlopeForm::ikeuchi_secant>};
const Learner ikeuchi_mixed_learner{"ikeuchi-mixed",
                                    "half constant, half 1 / cos of the slope (Ikeuchi 1981)",
                                    {},
                                    nullptr,
                                    learn_form<SlopeForm::ikeuchi_mixed>};

}  // namespace surf::workflow
