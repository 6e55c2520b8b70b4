// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/slope_model.h"

#include <algorithm>
#include <cmath>

#include "sem/facet/facet_kernels.h"
#include "sem/facet/facet_pass.h"
#include "sem/facet/transposed_fits.h"
#include "sem/model/engine_model.h"
#include "sem/model/model_input.h"
#include "slope_curve.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

using facet::Block;

struct Slopes {
  std::vector<FacetScale> scale;
  SlopeCurves curves;
};

template <class T>
class SlopeEngine {
 public:
  SlopeEngine(const Slopes& slopes, double pitch_x_nm, double pitch_y_nm,
              const ModelOptions& options)
      : slopes_(slopes), options_(options), pass_(slopes.scale, pitch_x_nm, pitch_y_nm) {
    options_.threads = resolve_threads(options.threads);
  }

  ModelImages predict(const Grid<double>& z_nm) const {
    ModelImages images = blank(z_nm);
    const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
    std::vector<Worker> workers(options_.threads);
    parallel_for(
        blocks.size(), options_.threads,
        [&](std::size_t i, int w) {
          const Block& block = blocks[i];
          Worker& worker = workers[w];
          measure(fit(z_nm, block, worker.scratch), block, worker);
          std::vector<double*> to(images.size());
          for (int y = 0; y < block.rows; ++y) {
            for (std::size_t c = 0; c < images.size(); ++c)
              to[c] = &images[c](block.x, block.y + y);
            slopes_.curves.yields(worker.row(y, pass_.columns(), block.width), to.data());
          }
        },
        options_.watch);
    return images;
  }

  Grid<double> gradient(const Grid<double>& z_nm, const ModelImages& weights) const {
    Grid<double> gradient(z_nm.width(), z_nm.height());
    double unit = 0;
    for (const Grid<double>& image : weights) unit = std::max(unit, magnitude(image.data()));
    if (unit == 0) return gradient;
    const int columns = pass_.columns();
    std::vector<Worker> workers(options_.threads);
    facet::TransposedFits<T> transposed(pass_, options_.edge, options_.threads);
    transposed.add_all(
        [&](int w, int, const Block& block, std::size_t, T* to) {
          std::fill_n(to, static_cast<std::size_t>(block.rows) * facet::coefficients * columns,
                      T(0));
          const T* k = fit(z_nm, block, workers[w].scratch);
          const double floor = pass_.floors(0, workers[w].scratch).slope;
          measure(k, block, workers[w]);
          for (int y = 0; y < block.rows;
               ++y, k += facet::coefficients * columns, to += facet::coefficients * columns) {
            const SlopeRow row = workers[w].row(y, columns, block.width);
            const std::vector<double*>& derivatives = derivatives_at(row, workers[w]);
            for (int x = 0; x < block.width; ++x) {
              // The mean of the one-sided derivatives of a length is 0.
              if (row.tangent[x] <= floor) continue;
              double sum = 0;
              for (std::size_t c = 0; c < weights.size(); ++c)
                sum += weights[c](block.x + x, block.y + y) / unit * derivatives[c][x];
              to[x] = T(sum * (k[x] / row.tangent[x]));
              to[x + columns] = T(sum * (k[x + columns] / row.tangent[x]));
            }
          }
        },
        unit, gradient);
    return gradient;
  }

  ModelImages change(const Grid<double>& z_nm, const Grid<double>& dz_nm) const {
    ModelImages images = blank(z_nm);
    const double unit = magnitude(dz_nm.data());
    if (unit == 0) return images;
    Grid<double> direction = dz_nm;
    for (double& dz : direction.data()) dz /= unit;
    const int columns = pass_.columns();
    const std::vector<Block> blocks = pass_.blocks(z_nm.width(), z_nm.height());
    std::vector<Worker> workers(options_.threads);
    std::vector<Scratch> along(options_.threads);
    parallel_for(blocks.size(), options_.threads, [&](std::size_t i, int w) {
      const Block& block = blocks[i];
      const T* k = fit(z_nm, block, workers[w].scratch);
      const T* d = fit(direction, block, along[w]);
      const double floor = pass_.floors(0, workers[w].scratch).slope;
      measure(k, block, workers[w]);
      for (int y = 0; y < block.rows;
           ++y, k += facet::coefficients * columns, d += facet::coefficients * columns) {
        const SlopeRow row = workers[w].row(y, columns, block.width);
        const std::vector<double*>& derivatives = derivatives_at(row, workers[w]);
        for (int x = 0; x < block.width; ++x) {
          const double slope = row.tangent[x];
          if (slope <= floor) continue;
          const double rise = (k[x] / slope) * d[x] + (k[x + columns] / slope) * d[x + columns];
          for (std::size_t c = 0; c < images.size(); ++c)
            images[c](block.x + x, block.y + y) = unit * rise * derivatives[c][x];
        }
      }
    });
    return images;
  }

 private:
  using Scratch = typename facet::FacetPass<T>::Scratch;
  struct Worker {
    Scratch scratch;
    AlignedVector<double> tangent, secant, angle, derivatives;
    std::vector<double*> channels;  ///< pointers into derivatives

    SlopeRow row(int y, int columns, int width) const {
      const std::ptrdiff_t at = std::ptrdiff_t{y} * columns;
      return {tangent.data() + at, secant.data() + at, angle.data() + at, width};
    }
  };

  ModelImages blank(const Grid<double>& z_nm) const {
    return ModelImages(slopes_.curves.channels(), Grid<double>(z_nm.width(), z_nm.height()));
  }

  const T* fit(const Grid<double>& z_nm, const Block& block, Scratch& scratch) const {
    pass_.load(z_nm, options_.edge, block, scratch);
    return pass_.fit(0, scratch);
  }

  void measure(const T* k, const Block& block, Worker& worker) const {
    const std::size_t count = static_cast<std::size_t>(block.rows) * pass_.columns();
    for (AlignedVector<double>* values : {&worker.tangent, &worker.secant, &worker.angle})
      values->resize(count);
    pass_.loops().angles(k, block.rows, worker.tangent.data(), worker.secant.data(),
                         worker.angle.data());
  }

  const std::vector<double*>& derivatives_at(const SlopeRow& row, Worker& worker) const {
    const std::size_t channels = slopes_.curves.channels();
    worker.derivatives.resize(channels * pass_.columns());
    worker.channels.resize(channels);
    for (std::size_t c = 0; c < channels; ++c)
      worker.channels[c] = worker.derivatives.data() + c * pass_.columns();
    slopes_.curves.derivatives(row, worker.channels.data());
    return worker.channels;
  }

  const Slopes& slopes_;
  ModelOptions options_;
  facet::FacetPass<T> pass_;
};

struct SlopeModel {
  using Parameters = Slopes;
  template <class Work>
  static auto run(const Parameters& slopes, double pitch_x_nm, double pitch_y_nm,
                  const ModelOptions& options, const Work& work) {
    if (options.double_precision)
      return work(SlopeEngine<double>(slopes, pitch_x_nm, pitch_y_nm, options));
    return work(SlopeEngine<float>(slopes, pitch_x_nm, pitch_y_nm, options));
  }
};

}  // namespace

std::shared_ptr<const ImageModel> make_slope_model(const ModelScope& scope,
                                                   const SlopeModelParameters& parameters) {
  facet_kernel(parameters.facet, 1);  // throws if it is out of range
  Slopes slopes{{parameters.facet}, SlopeCurves(parameters)};
  std::vector<std::string> names;
  for (const SlopeChannel& channel : parameters.channels) names.push_back(channel.name);
  check_channels(names, "slope model");
  return std::make_shared<EngineModel<SlopeModel>>(scope, std::move(names), std::move(slopes));
}

}  // namespace surf
