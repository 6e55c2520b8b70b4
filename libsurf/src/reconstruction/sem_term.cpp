// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_term.h"

namespace surf::reconstruction {

SemTerm::SemTerm(const SemData& data, const SurfaceFrame& frame, int left, int below, int threads)
    : model_(data.model), frame_(frame), noise_(data.noise), channels_(data.model->channels().size()),
      image_(frame.width, frame.height), used_(frame.width, frame.height) {
  options_.threads = threads;
  for (int y = 0; y < data.image.values.height(); ++y)
    for (int x = 0; x < data.image.values.width(); ++x) {
      if (!data.image.is_valid(x, y)) continue;
      image_(x + left, y + below) = data.image.values(x, y);
      used_(x + left, y + below) = 1;
      ++used_pixels_;
    }
}

Grid<double> SemTerm::mixed(const ModelImages& images, const std::vector<double>& mixture) const {
  Grid<double> out(frame_.width, frame_.height, mixture[channels_]);
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += mixture[c] * images[c].data()[i];
  return out;
}

SemTerm::State SemTerm::evaluate(const Grid<double>& z, const std::vector<double>& mixture) const {
  State s;
  s.linear = model_->linearize(frame_.field(z), options_);
  s.simulated = mixed(s.linear->images(), mixture);
  s.value = -log_likelihood(image_, s.simulated, noise_, used_, &s.pull, &s.information);
  for (double& p : s.pull.data()) p = -p;
  return s;
}

void SemTerm::add_gradient(const State& s, const std::vector<double>& mixture, const Grid<double>& weights,
                           Grid<double>& out, std::vector<double>* by_mixture) const {
  ModelImages w;
  for (std::size_t c = 0; c < channels_; ++c) {
    w.push_back(weights);
    for (double& v : w.back().data()) v *= mixture[c];
  }
  const Grid<double> gradient = s.linear->gradient(w);
  for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += gradient.data()[i];
  if (!by_mixture) return;
  for (std::size_t c = 0; c <= channels_; ++c) {
    double sum = 0;
    for (std::size_t i = 0; i < out.size(); ++i)
      sum += weights.data()[i] * (c < channels_ ? s.linear->images()[c].data()[i] : 1);
    (*by_mixture)[c] += sum;
  }
}

Grid<double> SemTerm::change(const State& s, const std::vector<double>& mixture, const Grid<double>& dz,
                             const std::vector<double>& mixture_change) const {
  const ModelImages d = s.linear->change(dz);
  Grid<double> out(frame_.width, frame_.height, mixture_change[channels_]);
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t i = 0; i < out.size(); ++i)
      out.data()[i] += mixture[c] * d[c].data()[i] + mixture_change[c] * s.linear->images()[c].data()[i];
  return out;
}

}  // namespace surf::reconstruction
