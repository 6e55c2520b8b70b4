// SPDX-License-Identifier: GPL-3.0-or-later
#include "network_engine.h"

#include <algorithm>
#include <cmath>

#include "sem/model/border.h"
#include "sem/model/model_input.h"
#include "surf/core/parallel.h"

namespace surf {

using facet::Block;
using network::SkyPlane;
using network::SkySample;

namespace {

double length_nm(const FacetScale& scale, double pitch_nm) {
  const double sigma = scale.sigma_px > 0 ? scale.sigma_px : scale.size / std::sqrt(12.0);
  return 2 * sigma * pitch_nm;
}

}  // namespace

template <class T>
struct NetworkEngine<T>::Worker {
  typename facet::FacetPass<T>::Scratch scratch, along;
  AlignedVector<T> inputs;          // [row][input][column]
  AlignedVector<T> values, slopes;  // of the units, for one row
  AlignedVector<T> in, out, work, along_sky;
};

template <class T>
struct NetworkEngine<T>::Planes {
  SkyPlane<T> heights;
  std::vector<SkySample<T>> samples;
};

template <class T>
NetworkEngine<T>::NetworkEngine(const FacetNetworkParameters& parameters, double pitch_nm,
                                const ModelOptions& options)
    : parameters_(parameters), options_(options), pass_(parameters.scales, pitch_nm, pitch_nm),
      view_(parameters.sky_edges_nm, pitch_nm), loops_(&network::operations<T>()),
      inputs_(network_inputs(parameters)) {
  options_.threads = resolve_threads(options.threads);
  for (const FacetScale& scale : parameters.scales)
    lengths_.push_back(T(length_nm(scale, pitch_nm)));
  for (const DenseLayer& layer : parameters.layers) {
    for (const double w : layer.weights) numbers_.push_back(T(w));
    for (const double b : layer.biases) numbers_.push_back(T(b));
  }
  widest_ = inputs_;
  const T* at = numbers_.data();
  for (const DenseLayer& layer : parameters.layers) {
    const std::size_t weights = layer.weights.size();
    layers_.push_back({layer.inputs, layer.outputs, at, at + weights});
    at += weights + layer.biases.size();
    units_ += layer.outputs;
    widest_ = std::max(widest_, layer.outputs);
  }
}

template <class T>
ModelImages NetworkEngine<T>::blank(const Grid<double>& z_nm) const {
  return ModelImages(parameters_.channels.size(), Grid<double>(z_nm.width(), z_nm.height()));
}

template <class T>
void NetworkEngine<T>::take_inputs(const Grid<double>& z_nm, const Planes& planes,
                                   const Block& block, Worker& worker, facet::KeptFits<T>* kept,
                                   std::size_t number) const {
  const int columns = pass_.columns();
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  worker.inputs.resize(static_cast<std::size_t>(block.rows * stride));
  pass_.load(z_nm, options_.edge, block, worker.scratch);
  T* out = worker.inputs.data();
  for (int s = 0; s < pass_.scales(); ++s, out += network::facet_inputs * columns) {
    const T* const k = pass_.fit(s, worker.scratch);
    loops_->facets(k, block.rows, lengths_[s], out, stride);
    if (kept) kept->keep(number, s, block.rows, columns, k, {});
  }
  if (view_.bands() == 0) return;
  for (int y = 0; y < block.rows; ++y)
    loops_->sky(planes.heights.at(block.x, block.y + y), planes.samples.data(),
                static_cast<int>(planes.samples.size()), view_.bands(), out + y * stride);
}

/// Runs the network on the block's inputs and writes the outputs to the images.
template <class T>
void NetworkEngine<T>::put(const Block& block, double unit, Worker& worker,
                           ModelImages& images) const {
  const int columns = pass_.columns();
  worker.values.resize(static_cast<std::size_t>(units_) * columns);
  worker.slopes.resize(worker.values.size());
  const T* const last = worker.values.data() + (units_ - layers_.back().outputs) * columns;
  for (int y = 0; y < block.rows; ++y) {
    loops_->forward(layers_.data(), static_cast<int>(layers_.size()),
                    worker.inputs.data() + std::ptrdiff_t{y} * inputs_ * columns,
                    worker.values.data(), worker.slopes.data());
    for (std::size_t c = 0; c < images.size(); ++c) {
      const double scale = unit * parameters_.channels[c].scale;
      for (int x = 0; x < block.width; ++x)
        images[c](block.x + x, block.y + y) = scale * last[c * columns + x];
    }
  }
}

template <class T>
ModelImages NetworkEngine<T>::predict(const Grid<double>& z_nm, Kept* kept) const {
  ModelImages images = blank(z_nm);
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  Planes planes{{z_nm, z_nm(0, 0), 1, options_.edge, view_.reach(), pass_.columns()}, {}};
  planes.samples = network::in_plane<T>(view_, planes.heights.stride);
  if (kept) {
    const std::size_t bytes = static_cast<std::size_t>(z_nm.height()) * planes.heights.stride *
                              static_cast<std::size_t>(inputs_) * sizeof(T);
    kept->fits.prepare(blocks, pass_.scales(), pass_.columns(), bytes);
    if (kept->fits.empty()) kept = nullptr;
    else kept->inputs.resize(blocks.size());
  }
  std::vector<Worker> workers(options_.threads);
  parallel_for(
      blocks.size(), options_.threads,
      [&](std::size_t i, int w) {
        take_inputs(z_nm, planes, blocks[i], workers[w], kept ? &kept->fits : nullptr, i);
        put(blocks[i], 1, workers[w], images);
        if (kept) kept->inputs[i] = workers[w].inputs;
      },
      options_.watch);
  return images;
}

template <class T>
void NetworkEngine<T>::inputs(const Grid<double>& z_nm, const Sink& sink) const {
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  Planes planes{{z_nm, z_nm(0, 0), 1, options_.edge, view_.reach(), pass_.columns()}, {}};
  planes.samples = network::in_plane<T>(view_, planes.heights.stride);
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    take_inputs(z_nm, planes, blocks[i], workers[w]);
    sink(blocks[i], pass_.columns(), workers[w].inputs.data());
  });
}

template <class T>
Grid<double> NetworkEngine<T>::gradient(const Grid<double>& z_nm, const ModelImages& weights,
                                        const Kept& kept) const {
  Grid<double> gradient(z_nm.width(), z_nm.height());
  double unit = 0;
  for (std::size_t c = 0; c < weights.size(); ++c)
    unit = std::max(unit, magnitude(weights[c].data()) * parameters_.channels[c].scale);
  if (unit == 0) return gradient;

  const int columns = pass_.columns(), count = static_cast<int>(layers_.size());
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  Planes planes{{z_nm, z_nm(0, 0), 1, options_.edge, view_.reach(), columns}, {}};
  planes.samples = network::in_plane<T>(view_, planes.heights.stride);
  // The sky view's derivatives of each block go to a tile of their own. The tiles are added in the
  // order of the blocks, so that threads do not change the result.
  const int reach = view_.reach();
  const std::ptrdiff_t tile_stride = columns + 2 * reach;
  std::vector<std::ptrdiff_t> to;
  for (const network::SkyView::Sample& s : view_.samples()) to.push_back(s.dy * tile_stride + s.dx);
  struct Given {
    AlignedVector<T> inputs;  // weights of the inputs, [row][input][column]
    AlignedVector<T> tile;
  };
  std::vector<Given> given(blocks.size());
  std::vector<Worker> workers(options_.threads);
  const int at_once = 8 * options_.threads;
  for (std::size_t first = 0; first < blocks.size(); first += at_once) {
    const std::size_t end = std::min(blocks.size(), first + at_once);
    parallel_for(end - first, options_.threads, [&](std::size_t i, int w) {
      const Block& block = blocks[first + i];
      Given& mine = given[first + i];
      Worker& worker = workers[w];
      if (kept.inputs.empty()) take_inputs(z_nm, planes, block, worker);
      const AlignedVector<T>& inputs = kept.inputs.empty() ? worker.inputs : kept.inputs[first + i];
      worker.values.resize(static_cast<std::size_t>(units_) * columns);
      worker.slopes.resize(worker.values.size());
      worker.work.resize(2 * static_cast<std::size_t>(widest_) * columns);
      worker.out.assign(static_cast<std::size_t>(columns) * weights.size(), T(0));
      worker.along_sky.resize(planes.samples.size() * columns);
      mine.inputs.resize(static_cast<std::size_t>(block.rows * stride));
      mine.tile.assign(static_cast<std::size_t>(tile_stride * (block.rows + 2 * reach)), T(0));
      for (int y = 0; y < block.rows; ++y) {
        for (std::size_t c = 0; c < weights.size(); ++c) {
          const double scale = parameters_.channels[c].scale / unit;
          for (int x = 0; x < block.width; ++x)
            worker.out[c * columns + x] = T(weights[c](block.x + x, block.y + y) * scale);
        }
        T* const back = mine.inputs.data() + y * stride;
        loops_->forward(layers_.data(), count, inputs.data() + y * stride, worker.values.data(),
                        worker.slopes.data());
        loops_->backward(layers_.data(), count, worker.slopes.data(), worker.out.data(),
                         worker.work.data(), back);
        if (view_.bands() > 0)
          loops_->sky_back(planes.heights.at(block.x, block.y + y), planes.samples.data(),
                           static_cast<int>(planes.samples.size()), view_.bands(),
                           back + pass_.scales() * network::facet_inputs * columns,
                           mine.tile.data() + (y + reach) * tile_stride + reach, to.data(),
                           worker.along_sky.data());
      }
    });
    for (std::size_t i = first; i < end; ++i) {
      const Block& block = blocks[i];
      for (int y = -reach; y < block.rows + reach; ++y) {
        const int row = border_sample(block.y + y, z_nm.height(), options_.edge);
        const T* const from = given[i].tile.data() + (y + reach) * tile_stride + reach;
        // Beyond the block's width all values are 0, because their weights are 0.
        for (int x = -reach; x < columns + reach; ++x)
          if (from[x] != 0)
            gradient(border_sample(block.x + x, z_nm.width(), options_.edge), row) +=
                unit * from[x];
      }
      given[i].tile = {};
    }
  }

  const std::size_t strips = (z_nm.width() + columns - 1) / columns;
  const auto source = [&](int w, int scale, const Block& column, T* out) {
    Worker& worker = workers[w];
    for (std::size_t i = column.x / columns; i < blocks.size(); i += strips) {
      if (kept.inputs.empty()) pass_.load(z_nm, options_.edge, blocks[i], worker.scratch, scale);
      loops_->facets_back(
          kept.inputs.empty() ? pass_.fit(scale, worker.scratch)
                              : kept.fits.at(i, scale).coefficients.data(),
          blocks[i].rows, lengths_[scale],
          given[i].inputs.data() + scale * network::facet_inputs * columns, stride,
          out + static_cast<std::ptrdiff_t>(blocks[i].y) * facet::coefficients * columns);
    }
  };
  pass_.transpose(options_.edge, options_.threads, source, unit, gradient);
  return gradient;
}

template <class T>
ModelImages NetworkEngine<T>::change(const Grid<double>& z_nm, const Grid<double>& dz_nm,
                                     const Kept& kept) const {
  ModelImages images = blank(z_nm);
  const double unit = magnitude(dz_nm.data());
  if (unit == 0) return images;
  Grid<double> direction = dz_nm;
  for (double& dz : direction.data()) dz /= unit;

  const int columns = pass_.columns(), count = static_cast<int>(layers_.size());
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  Planes planes{{z_nm, z_nm(0, 0), 1, options_.edge, view_.reach(), columns}, {}};
  planes.samples = network::in_plane<T>(view_, planes.heights.stride);
  const SkyPlane<T> moved(direction, direction(0, 0), 1, options_.edge, view_.reach(), columns);
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    Worker& worker = workers[w];
    if (kept.inputs.empty()) take_inputs(z_nm, planes, block, worker);
    const AlignedVector<T>& inputs = kept.inputs.empty() ? worker.inputs : kept.inputs[i];
    pass_.load(direction, options_.edge, block, worker.along);
    worker.in.resize(static_cast<std::size_t>(block.rows * stride));
    for (int s = 0; s < pass_.scales(); ++s)
      loops_->facets_change(kept.inputs.empty() ? pass_.fit(s, worker.scratch)
                                                : kept.fits.at(i, s).coefficients.data(),
                            pass_.fit(s, worker.along), block.rows, lengths_[s],
                            worker.in.data() + s * network::facet_inputs * columns, stride);
    worker.values.resize(static_cast<std::size_t>(units_) * columns);
    worker.slopes.resize(worker.values.size());
    worker.work.resize(2 * static_cast<std::size_t>(widest_) * columns);
    worker.out.resize(static_cast<std::size_t>(columns) * images.size());
    for (int y = 0; y < block.rows; ++y) {
      T* const in = worker.in.data() + y * stride;
      if (view_.bands() > 0)
        loops_->sky_change(planes.heights.at(block.x, block.y + y), moved.at(block.x, block.y + y),
                           planes.samples.data(), static_cast<int>(planes.samples.size()),
                           view_.bands(), in + pass_.scales() * network::facet_inputs * columns);
      loops_->forward(layers_.data(), count, inputs.data() + y * stride, worker.values.data(),
                      worker.slopes.data());
      loops_->change(layers_.data(), count, worker.slopes.data(), in, worker.work.data(),
                     worker.out.data());
      for (std::size_t c = 0; c < images.size(); ++c)
        for (int x = 0; x < block.width; ++x)
          images[c](block.x + x, block.y + y) =
              unit * parameters_.channels[c].scale * worker.out[c * columns + x];
    }
  });
  return images;
}

template class NetworkEngine<float>;
template class NetworkEngine<double>;

}  // namespace surf
