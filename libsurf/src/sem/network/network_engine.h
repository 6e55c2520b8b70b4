// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "network_operations.h"
#include "sem/facet/facet_pass.h"
#include "sky_view.h"
#include "surf/sem/facet_network.h"
#include "surf/sem/image_model.h"

namespace surf {

/// The passes of a network in float or double. Parameters and fields must have been checked.
/// Without layers only the inputs are available.
template <class T>
class NetworkEngine {
 public:
  NetworkEngine(const FacetNetworkParameters& parameters, double pitch_nm,
                const ModelOptions& options);

  ModelImages predict(const Grid<double>& z_nm) const;
  Grid<double> gradient(const Grid<double>& z_nm, const ModelImages& weights) const;
  ModelImages change(const Grid<double>& z_nm, const Grid<double>& dz_nm) const;

  /// Receives the inputs of a block: row after row, each `columns` long. Called from several
  /// threads.
  using Sink = std::function<void(const facet::Block& block, int columns, const T* inputs)>;
  void inputs(const Grid<double>& z_nm, const Sink& sink) const;

 private:
  struct Worker;
  struct Planes;
  struct Given;
  Planes planes(const Grid<double>& z_nm) const;
  /// Into worker.inputs.
  void take_inputs(const Grid<double>& z_nm, const Planes& planes, const facet::Block& block,
                   Worker& worker) const;
  void pull_back(const Grid<double>& z_nm, const ModelImages& weights, double unit,
                 const Planes& planes, const facet::Block& block, Worker& worker,
                 const Given& given) const;
  void add_sky(const facet::Block& block, const Given& given, double unit,
               Grid<double>& gradient) const;
  void put(const facet::Block& block, double unit, Worker& worker, ModelImages& images) const;
  ModelImages blank(const Grid<double>& z_nm) const;

  const FacetNetworkParameters& parameters_;
  ModelOptions options_;
  facet::FacetPass<T> pass_;
  network::SkyView view_;
  const network::Operations<T>* loops_;
  int per_scale_;           ///< inputs
  std::vector<T> lengths_;  ///< of the scales
  std::vector<T> numbers_;  ///< of the layers, one after the other
  std::vector<network::Layer<T>> layers_;
  int inputs_, units_ = 0, widest_ = 0;  ///< units of all layers; widest of inputs and layers
};

extern template class NetworkEngine<float>;
extern template class NetworkEngine<double>;

}  // namespace surf
