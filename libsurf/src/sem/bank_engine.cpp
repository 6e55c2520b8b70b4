// SPDX-License-Identifier: GPL-3.0-or-later
#include "bank_engine.h"

#include <algorithm>

#include "model_input.h"
#include "surf/core/parallel.h"

namespace surf {

using facet::Block;

template <class T>
BankEngine<T>::BankEngine(const FilterBankParameters& parameters, double pitch_x_nm, double pitch_y_nm,
                          const ModelOptions& options)
    : parameters_(parameters), options_(options), pass_(parameters.scales, pitch_x_nm, pitch_y_nm) {
  options_.threads = resolve_threads(options.threads);
  for (std::size_t i = 0; i < parameters.scales.size(); ++i) {
    auto& weights = weights_.emplace_back();
    for (const FilterBankChannel& c : parameters.channels)
      weights.push_back({T(c.slope[i]), T(c.max_curvature[i]), T(c.min_curvature[i])});
  }
}

template <class T>
ModelImages BankEngine<T>::blank(const Grid<double>& z_nm, bool with_offset) const {
  ModelImages images;
  for (const FilterBankChannel& c : parameters_.channels)
    images.emplace_back(z_nm.width(), z_nm.height(), with_offset ? c.offset : 0.0);
  return images;
}

template <class T>
void BankEngine<T>::add(const Block& block, const AlignedVector<T>& sum, double unit, ModelImages& images) const {
  const T* from = sum.data();
  for (Grid<double>& image : images)
    for (int y = 0; y < block.rows; ++y, from += pass_.columns())
      for (int x = 0; x < block.width; ++x) image(block.x + x, block.y + y) += unit * from[x];
}

template <class T>
ModelImages BankEngine<T>::predict(const Grid<double>& z_nm) const {
  ModelImages images = blank(z_nm, true);
  const int channels = static_cast<int>(images.size());
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  struct Worker {
    Scratch scratch;
    AlignedVector<T> sum;
  };
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    auto& [scratch, sum] = workers[w];
    sum.assign(static_cast<std::size_t>(channels) * block.rows * pass_.columns(), T(0));
    pass_.load(z_nm, options_.edge, block, scratch);
    for (int s = 0; s < pass_.scales(); ++s)
      pass_.loops().combine(pass_.fit(s, scratch), block.rows, weights_[s].data(), channels, sum.data());
    add(block, sum, 1, images);
  });
  return images;
}

template <class T>
Grid<double> BankEngine<T>::gradient(const Grid<double>& z_nm, const ModelImages& weights) const {
  Grid<double> gradient(z_nm.width(), z_nm.height());
  double unit = 0;
  for (const Grid<double>& image : weights) unit = std::max(unit, magnitude(image.data()));
  if (unit == 0) return gradient;
  const int channels = static_cast<int>(weights.size()), columns = pass_.columns();
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  const std::size_t parts = blocks.size() / ((z_nm.width() + columns - 1) / columns);
  std::vector<AlignedVector<T>> block_weights(blocks.size());
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int) {
    const Block& block = blocks[i];
    block_weights[i].resize(static_cast<std::size_t>(channels) * block.rows * columns);
    T* to = block_weights[i].data();
    for (const Grid<double>& image : weights)
      for (int y = 0; y < block.rows; ++y, to += columns)
        for (int x = 0; x < block.width; ++x) to[x] = T(image(block.x + x, block.y + y) / unit);
  });
  std::vector<Scratch> workers(options_.threads);
  const auto source = [&](int w, int scale, const Block& column, T* out) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t i = column.x / columns * parts + part;
      const Block& block = blocks[i];
      pass_.load(z_nm, options_.edge, block, workers[w], scale);
      const T* const k = pass_.fit(scale, workers[w]);
      pass_.loops().pull_back(k, block.rows, pass_.floors(scale, workers[w]), weights_[scale].data(), channels,
                              block_weights[i].data(),
                              out + static_cast<std::ptrdiff_t>(block.y) * facet::coefficients * columns);
    }
  };
  pass_.transpose(options_.edge, options_.threads, source, unit, gradient);
  return gradient;
}

template <class T>
ModelImages BankEngine<T>::change(const Grid<double>& z_nm, const Grid<double>& dz_nm) const {
  ModelImages images = blank(z_nm, false);
  const double unit = magnitude(dz_nm.data());
  if (unit == 0) return images;
  Grid<double> direction = dz_nm;
  for (double& dz : direction.data()) dz /= unit;
  const int channels = static_cast<int>(images.size());
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  struct Worker {
    Scratch at, along;
    AlignedVector<T> sum;
  };
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    auto& [at, along, sum] = workers[w];
    sum.assign(static_cast<std::size_t>(channels) * block.rows * pass_.columns(), T(0));
    pass_.load(z_nm, options_.edge, block, at);
    pass_.load(direction, options_.edge, block, along);
    for (int s = 0; s < pass_.scales(); ++s)
      pass_.loops().push_forward(pass_.fit(s, at), pass_.fit(s, along), block.rows, pass_.floors(s, at),
                                 weights_[s].data(), channels, sum.data());
    add(block, sum, unit, images);
  });
  return images;
}

template <class T>
void BankEngine<T>::invariants(const Grid<double>& z_nm, const Sink& sink) const {
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  struct Worker {
    Scratch scratch;
    std::vector<AlignedVector<T>> scales;
  };
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    auto& [scratch, scales] = workers[w];
    scales.resize(pass_.scales());
    pass_.load(z_nm, options_.edge, block, scratch);
    for (int s = 0; s < pass_.scales(); ++s) {
      scales[s].resize(static_cast<std::size_t>(block.rows) * 3 * pass_.columns());
      pass_.loops().invariants(pass_.fit(s, scratch), block.rows, scales[s].data());
    }
    sink(block, pass_.columns(), scales);
  });
}

template class BankEngine<float>;
template class BankEngine<double>;

}  // namespace surf
