// SPDX-License-Identifier: GPL-3.0-or-later
#include "bank_engine.h"

#include <algorithm>

#include "sem/model/model_input.h"
#include "surf/core/parallel.h"
#include "transposed_fits.h"

namespace surf {

using facet::Block;

namespace {

bool is_fine(const FilterBankParameters& parameters, const FacetScale& scale) {
  return !parameters.multi_resolution || facet::halvings(scale) == 0;
}

std::vector<FacetScale> fine_scales(const FilterBankParameters& parameters) {
  std::vector<FacetScale> scales;
  for (const FacetScale& scale : parameters.scales)
    if (is_fine(parameters, scale)) scales.push_back(scale);
  return scales;
}

}  // namespace

template <class T>
BankEngine<T>::BankEngine(const FilterBankParameters& parameters, double pitch_x_nm,
                          double pitch_y_nm, const ModelOptions& options)
    : parameters_(parameters), options_(options), pitch_x_nm_(pitch_x_nm), pitch_y_nm_(pitch_y_nm),
      pass_(fine_scales(parameters), pitch_x_nm, pitch_y_nm) {
  options_.threads = resolve_threads(options.threads);
  for (std::size_t i = 0; i < parameters.scales.size(); ++i) {
    const bool fine = is_fine(parameters, parameters.scales[i]);
    fine_of_.push_back(fine ? static_cast<int>(scale_of_.size()) : -1);
    if (fine) scale_of_.push_back(static_cast<int>(i));
    auto& weights = weights_.emplace_back();
    for (const FilterBankChannel& c : parameters.channels)
      weights.push_back({T(c.slope[i]), T(c.max_curvature[i]), T(c.min_curvature[i])});
  }
}

template <class T>
facet::CoarseFits<T> BankEngine<T>::coarse_fits(const Grid<double>& z_nm) const {
  facet::CoarseFits<T> coarse(
      parameters_.multi_resolution ? parameters_.scales : std::vector<FacetScale>(), pitch_x_nm_,
      pitch_y_nm_);
  coarse.load(z_nm, options_.edge, options_.threads, {{}, options_.watch.cancel});
  return coarse;
}

template <class T>
const T* BankEngine<T>::fit(int scale, const facet::CoarseFits<T>& coarse, const Block& block,
                            Scratch& s) const {
  if (fine_of_[scale] >= 0) return pass_.fit(fine_of_[scale], s.fine);
  s.coarse.resize(static_cast<std::size_t>(block.rows) * facet::coefficients * pass_.columns());
  coarse.at(scale, block, pass_.columns(), s.between, s.coarse.data());
  return s.coarse.data();
}

template <class T>
facet::Floors<T> BankEngine<T>::floors(int scale, const facet::CoarseFits<T>& coarse,
                                       const Scratch& s) const {
  return fine_of_[scale] >= 0 ? pass_.floors(fine_of_[scale], s.fine) : coarse.floors(scale);
}

template <class T>
ModelImages BankEngine<T>::blank(const Grid<double>& z_nm, bool with_offset) const {
  ModelImages images;
  for (const FilterBankChannel& c : parameters_.channels)
    images.emplace_back(z_nm.width(), z_nm.height(), with_offset ? c.offset : 0.0);
  return images;
}

template <class T>
void BankEngine<T>::add(const Block& block, const AlignedVector<T>& sum, double unit,
                        ModelImages& images) const {
  const T* from = sum.data();
  for (Grid<double>& image : images)
    for (int y = 0; y < block.rows; ++y, from += pass_.columns())
      for (int x = 0; x < block.width; ++x) image(block.x + x, block.y + y) += unit * from[x];
}

template <class T>
ModelImages BankEngine<T>::predict(const Grid<double>& z_nm) const {
  ModelImages images = blank(z_nm, true);
  const int channels = static_cast<int>(images.size());
  const facet::CoarseFits<T> coarse = coarse_fits(z_nm);
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  struct Worker {
    Scratch scratch;
    AlignedVector<T> sum;
  };
  std::vector<Worker> workers(options_.threads);
  parallel_for(
      blocks.size(), options_.threads,
      [&](std::size_t i, int w) {
        const Block& block = blocks[i];
        auto& [scratch, sum] = workers[w];
        sum.assign(static_cast<std::size_t>(channels) * block.rows * pass_.columns(), T(0));
        pass_.load(z_nm, options_.edge, block, scratch.fine);
        for (int s = 0; s < scales(); ++s) {
          pass_.loops().combine(fit(s, coarse, block, scratch), block.rows, weights_[s].data(),
                                channels, sum.data());
        }
        add(block, sum, 1, images);
      },
      options_.watch);
  return images;
}

/// Takes a block's weights of the images, divided by `unit`, a power of two.
template <class T>
void BankEngine<T>::take_weights(const ModelImages& weights, double unit, const Block& block,
                                 AlignedVector<T>& out) const {
  const int columns = pass_.columns();
  out.resize(weights.size() * static_cast<std::size_t>(block.rows) * columns);
  const double per_unit = 1 / unit;
  T* to = out.data();
  for (const Grid<double>& image : weights)
    for (int y = 0; y < block.rows; ++y, to += columns) {
      const double* const from = &image(block.x, block.y + y);
      for (int x = 0; x < block.width; ++x) to[x] = T(from[x] * per_unit);
      std::fill(to + block.width, to + columns, T(0));
    }
}

/// Computes weights of a scale's coefficients at a block's pixels from those of the images.
template <class T>
void BankEngine<T>::pull_back(const Grid<double>& z_nm, const AlignedVector<T>& weights, int scale,
                              const facet::CoarseFits<T>& coarse, const Block& block,
                              Scratch& scratch, T* out) const {
  if (fine_of_[scale] >= 0) pass_.load(z_nm, options_.edge, block, scratch.fine, fine_of_[scale]);
  const T* const k = fit(scale, coarse, block, scratch);
  pass_.loops().pull_back(k, block.rows, floors(scale, coarse, scratch), weights_[scale].data(),
                          static_cast<int>(parameters_.channels.size()), weights.data(), out);
}

template <class T>
Grid<double> BankEngine<T>::gradient(const Grid<double>& z_nm, const ModelImages& weights) const {
  Grid<double> gradient(z_nm.width(), z_nm.height());
  double unit = 0;
  for (const Grid<double>& image : weights) unit = std::max(unit, magnitude(image.data()));
  if (unit == 0) return gradient;
  const facet::CoarseFits<T> coarse = coarse_fits(z_nm);
  std::vector<Scratch> workers(options_.threads);
  facet::TransposedFits<T> transposed(pass_, options_.edge, options_.threads);
  std::vector<AlignedVector<T>> of_tile;
  for (const facet::Tile& tile : transposed.tiles(z_nm.width(), z_nm.height())) {
    of_tile.resize(std::max(of_tile.size(), tile.blocks.size()));
    parallel_for(tile.blocks.size(), options_.threads, [&](std::size_t i, int) {
      take_weights(weights, unit, tile.blocks[i], of_tile[i]);
    });
    transposed.add(
        tile,
        [&](int w, int fine, const Block& block, std::size_t i, T* out) {
          pull_back(z_nm, of_tile[i], scale_of_[fine], coarse, block, workers[w], out);
        },
        unit, gradient);
  }
  const int columns = pass_.columns();
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  const std::size_t strips = (z_nm.width() + columns - 1) / columns;
  coarse.transpose(
      [&](int w, int scale, const Block& column, T* out) {
        for (std::size_t i = column.x / columns; i < blocks.size(); i += strips) {
          Scratch& scratch = workers[w];
          take_weights(weights, unit, blocks[i], scratch.weights);
          pull_back(z_nm, scratch.weights, scale, coarse, blocks[i], scratch,
                    out + static_cast<std::ptrdiff_t>(blocks[i].y) * facet::coefficients * columns);
        }
      },
      columns, options_.edge, options_.threads, unit, gradient);
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
  const facet::CoarseFits<T> coarse = coarse_fits(z_nm), coarse_direction = coarse_fits(direction);
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
    pass_.load(z_nm, options_.edge, block, at.fine);
    pass_.load(direction, options_.edge, block, along.fine);
    for (int s = 0; s < scales(); ++s) {
      const T* const k = fit(s, coarse, block, at);
      pass_.loops().push_forward(k, fit(s, coarse_direction, block, along), block.rows,
                                 floors(s, coarse, at), weights_[s].data(), channels, sum.data());
    }
    add(block, sum, unit, images);
  });
  return images;
}

template <class T>
void BankEngine<T>::invariants(const Grid<double>& z_nm, const Sink& sink) const {
  const facet::CoarseFits<T> coarse = coarse_fits(z_nm);
  const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
  struct Worker {
    Scratch scratch;
    std::vector<AlignedVector<T>> invariants;
  };
  std::vector<Worker> workers(options_.threads);
  parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
    const Block& block = blocks[i];
    auto& [scratch, found] = workers[w];
    found.resize(scales());
    pass_.load(z_nm, options_.edge, block, scratch.fine);
    for (int s = 0; s < scales(); ++s) {
      found[s].resize(static_cast<std::size_t>(block.rows) * 3 * pass_.columns());
      pass_.loops().invariants(fit(s, coarse, block, scratch), block.rows, found[s].data());
    }
    sink(i, block, pass_.columns(), found);
  });
}

template class BankEngine<float>;
template class BankEngine<double>;

}  // namespace surf
