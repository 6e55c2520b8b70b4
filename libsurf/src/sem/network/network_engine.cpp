// SPDX-License-Identifier: GPL-3.0-or-later
#include "network_engine.h"

#include <algorithm>
#include <cmath>

#include "sem/facet/transposed_fits.h"
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

/// The derivatives at a block: by the coefficients of each scale, one after the other, and by the
/// heights that the sky view of its pixels depends on, which reach beyond the block.
template <class T>
struct NetworkEngine<T>::Given {
  T *coefficients, *sky;
};

template <class T>
struct NetworkEngine<T>::Planes {
  SkyPlane<T> heights;
  std::vector<SkySample<T>> samples;
  std::ptrdiff_t tile_stride;      // of the sky's derivatives of a block
  std::vector<std::ptrdiff_t> to;  // places of the samples there
};

template <class T>
NetworkEngine<T>::NetworkEngine(const FacetNetworkParameters& parameters, double pitch_nm,
                                const ModelOptions& options)
    : parameters_(parameters), options_(options), pass_(parameters.scales, pitch_nm, pitch_nm),
      view_(parameters.sky_edges_nm, pitch_nm), loops_(&network::operations<T>(parameters.sided)),
      per_scale_(network::facet_inputs(parameters.sided)), inputs_(network_inputs(parameters)) {
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
typename NetworkEngine<T>::Planes NetworkEngine<T>::planes(const Grid<double>& z_nm) const {
  const int reach = view_.reach(), columns = pass_.columns();
  Planes planes{{z_nm, z_nm(0, 0), 1, options_.edge, reach, columns}, {}, columns + 2 * reach, {}};
  planes.samples = network::in_plane<T>(view_, planes.heights.stride);
  for (const network::SkyView::Sample& s : view_.samples())
    planes.to.push_back(s.dy * planes.tile_stride + s.dx);
  return planes;
}

template <class T>
void NetworkEngine<T>::take_inputs(const Grid<double>& z_nm, const Planes& planes,
                                   const Block& block, Worker& worker) const {
  const int columns = pass_.columns();
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  worker.inputs.resize(static_cast<std::size_t>(block.rows * stride));
  pass_.load(z_nm, options_.edge, block, worker.scratch);
  T* out = worker.inputs.data();
  for (int s = 0; s < pass_.scales(); ++s, out += per_scale_ * columns)
    loops_->facets(pass_.fit(s, worker.scratch), block.rows, lengths_[s], out, stride);
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
ModelImages NetworkEngine<T>::predict(const Grid<double>& z_nm) const {
  ModelImages images = blank(z_nm);
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  const Planes planes = this->planes(z_nm);
  std::vector<Worker> workers(options_.threads);
  parallel_for(
      blocks.size(), options_.threads,
      [&](std::size_t i, int w) {
        take_inputs(z_nm, planes, blocks[i], workers[w]);
        put(blocks[i], 1, workers[w], images);
      },
      options_.watch);
  return images;
}

template <class T>
void NetworkEngine<T>::inputs(const Grid<double>& z_nm, const Sink& sink) const {
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  const Planes planes = this->planes(z_nm);
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    take_inputs(z_nm, planes, blocks[i], workers[w]);
    sink(blocks[i], pass_.columns(), workers[w].inputs.data());
  });
}

/// Computes the derivatives at a block from the weights of its pixels.
template <class T>
void NetworkEngine<T>::pull_back(const Grid<double>& z_nm, const ModelImages& weights, double unit,
                                 const Planes& planes, const Block& block, Worker& worker,
                                 const Given& given) const {
  const int columns = pass_.columns(), count = static_cast<int>(layers_.size());
  const int reach = view_.reach();
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  take_inputs(z_nm, planes, block, worker);
  worker.values.resize(static_cast<std::size_t>(units_) * columns);
  worker.slopes.resize(worker.values.size());
  worker.work.resize(2 * static_cast<std::size_t>(widest_) * columns);
  worker.along_sky.resize(planes.samples.size() * columns);
  worker.out.assign(static_cast<std::size_t>(columns) * weights.size(), T(0));
  std::fill_n(given.sky, planes.tile_stride * (block.rows + 2 * reach), T(0));
  for (int y = 0; y < block.rows; ++y) {
    for (std::size_t c = 0; c < weights.size(); ++c) {
      const double scale = parameters_.channels[c].scale / unit;
      const double* const from = &weights[c](block.x, block.y + y);
      for (int x = 0; x < block.width; ++x) worker.out[c * columns + x] = T(from[x] * scale);
    }
    T* const inputs = worker.inputs.data() + y * stride;
    loops_->forward(layers_.data(), count, inputs, worker.values.data(), worker.slopes.data());
    // The inputs have done their work: their weights take their place.
    loops_->backward(layers_.data(), count, worker.slopes.data(), worker.out.data(),
                     worker.work.data(), inputs);
    if (view_.bands() > 0)
      loops_->sky_back(planes.heights.at(block.x, block.y + y), planes.samples.data(),
                       static_cast<int>(planes.samples.size()), view_.bands(),
                       inputs + pass_.scales() * per_scale_ * columns,
                       given.sky + (y + reach) * planes.tile_stride + reach, planes.to.data(),
                       worker.along_sky.data());
  }
  const std::ptrdiff_t size = std::ptrdiff_t{block.rows} * facet::coefficients * columns;
  for (int s = 0; s < pass_.scales(); ++s)
    loops_->facets_back(pass_.fit(s, worker.scratch), block.rows, lengths_[s],
                        worker.inputs.data() + s * per_scale_ * columns, stride,
                        given.coefficients + s * size);
}

template <class T>
void NetworkEngine<T>::add_sky(const Block& block, const Given& given, double unit,
                               Grid<double>& gradient) const {
  const int reach = view_.reach();
  const T* from = given.sky;
  for (int y = -reach; y < block.rows + reach; ++y, from += pass_.columns() + 2 * reach) {
    const int row = border_sample(block.y + y, gradient.height(), options_.edge);
    // Beyond the block's width all values are 0, because their weights are 0.
    add_continued(from, block.width + 2 * reach, block.x - reach, unit, options_.edge,
                  &gradient(0, row), gradient.width());
  }
}

template <class T>
Grid<double> NetworkEngine<T>::gradient(const Grid<double>& z_nm,
                                        const ModelImages& weights) const {
  Grid<double> gradient(z_nm.width(), z_nm.height());
  double unit = 0;
  for (std::size_t c = 0; c < weights.size(); ++c)
    unit = std::max(unit, magnitude(weights[c].data()) * parameters_.channels[c].scale);
  if (unit == 0) return gradient;
  const Planes planes = this->planes(z_nm);
  facet::TransposedFits<T> transposed(pass_, options_.edge, options_.threads);
  std::vector<Worker> workers(options_.threads);
  AlignedVector<T> memory;
  std::vector<Given> given;  // of a tile's blocks
  const std::ptrdiff_t row_size =
      std::ptrdiff_t{pass_.scales()} * facet::coefficients * pass_.columns();
  for (const facet::Tile& tile : transposed.tiles(z_nm.width(), z_nm.height())) {
    std::ptrdiff_t size = 0;
    for (const Block& block : tile.blocks)
      size += block.rows * row_size + (block.rows + 2 * view_.reach()) * planes.tile_stride;
    memory.resize(std::max(memory.size(), static_cast<std::size_t>(size)));
    given.clear();
    T* at = memory.data();
    for (const Block& block : tile.blocks) {
      given.push_back({at, at + block.rows * row_size});
      at = given.back().sky + (block.rows + 2 * view_.reach()) * planes.tile_stride;
    }
    parallel_for(tile.blocks.size(), options_.threads, [&](std::size_t i, int w) {
      pull_back(z_nm, weights, unit, planes, tile.blocks[i], workers[w], given[i]);
    });
    // In the order of the blocks, so that threads do not change the result.
    if (view_.bands() > 0)
      for (std::size_t i = 0; i < tile.blocks.size(); ++i)
        add_sky(tile.blocks[i], given[i], unit, gradient);
    transposed.add(
        tile,
        [&](int, int scale, const Block& block, std::size_t i, T* out) {
          const std::size_t count =
              static_cast<std::size_t>(block.rows) * facet::coefficients * pass_.columns();
          std::copy_n(given[i].coefficients + scale * count, count, out);
        },
        unit, gradient);
  }
  return gradient;
}

template <class T>
ModelImages NetworkEngine<T>::change(const Grid<double>& z_nm, const Grid<double>& dz_nm) const {
  ModelImages images = blank(z_nm);
  const double unit = magnitude(dz_nm.data());
  if (unit == 0) return images;
  Grid<double> direction = dz_nm;
  for (double& dz : direction.data()) dz /= unit;

  const int columns = pass_.columns(), count = static_cast<int>(layers_.size());
  const std::ptrdiff_t stride = std::ptrdiff_t{inputs_} * columns;
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  const Planes planes = this->planes(z_nm);
  const SkyPlane<T> moved(direction, direction(0, 0), 1, options_.edge, view_.reach(), columns);
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    Worker& worker = workers[w];
    take_inputs(z_nm, planes, block, worker);
    pass_.load(direction, options_.edge, block, worker.along);
    worker.in.resize(static_cast<std::size_t>(block.rows * stride));
    for (int s = 0; s < pass_.scales(); ++s)
      loops_->facets_change(pass_.fit(s, worker.scratch), pass_.fit(s, worker.along), block.rows,
                            lengths_[s], worker.in.data() + s * per_scale_ * columns, stride);
    worker.values.resize(static_cast<std::size_t>(units_) * columns);
    worker.slopes.resize(worker.values.size());
    worker.work.resize(2 * static_cast<std::size_t>(widest_) * columns);
    worker.out.resize(static_cast<std::size_t>(columns) * images.size());
    for (int y = 0; y < block.rows; ++y) {
      T* const in = worker.in.data() + y * stride;
      if (view_.bands() > 0)
        loops_->sky_change(planes.heights.at(block.x, block.y + y), moved.at(block.x, block.y + y),
                           planes.samples.data(), static_cast<int>(planes.samples.size()),
                           view_.bands(), in + pass_.scales() * per_scale_ * columns);
      loops_->forward(layers_.data(), count, worker.inputs.data() + y * stride,
                      worker.values.data(), worker.slopes.data());
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
