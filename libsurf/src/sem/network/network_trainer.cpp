// SPDX-License-Identifier: GPL-3.0-or-later
#include "network_trainer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>

#include <Eigen/Core>

#include "sem/minimise/minimise.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf {
namespace {

using Matrix = Eigen::MatrixXf;  // one column per pixel
using Row = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t pixels_at_once = 512;  // their activations stay in the cache
// Sums of a part are merged with others' in order.
constexpr std::size_t at_once_in_a_part = 8;
constexpr int lbfgs_rank = 40;
// Share of the mean signal; below it the noise is assumed to be as at this signal.
constexpr double faintest = 0.02;

struct Shape {
  std::vector<int> sizes;
  // Of the layers' numbers: weights [output][input], then biases.
  std::vector<std::size_t> starts;
  std::size_t numbers = 0;
};

Shape shape_of(const std::vector<DenseLayer>& layers) {
  Shape shape;
  shape.sizes.push_back(layers.front().inputs);
  for (const DenseLayer& layer : layers) {
    shape.starts.push_back(shape.numbers);
    shape.numbers += layer.weights.size() + layer.biases.size();
    shape.sizes.push_back(layer.outputs);
  }
  return shape;
}

/// Layers in single precision, with forward and backward passes over some pixels.
class Net {
 public:
  Net(const Shape& shape, const double* numbers) {
    for (std::size_t l = 0; l < shape.starts.size(); ++l) {
      const int in = shape.sizes[l], out = shape.sizes[l + 1];
      const double* const at = numbers + shape.starts[l];
      weights_.push_back(
          Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(at, out, in)
              .cast<float>());
      biases_.push_back(
          Eigen::Map<const Eigen::VectorXd>(at + std::ptrdiff_t{in} * out, out).cast<float>());
    }
  }

  struct Pass {
    std::vector<Matrix> values, slopes;  // values[0]: the inputs
  };

  void forward(Pass& pass) const {
    const std::size_t count = weights_.size();
    pass.values.resize(count + 1);
    pass.slopes.resize(count);
    for (std::size_t l = 0; l < count; ++l) {
      Matrix& z = pass.values[l + 1];
      z.noalias() = weights_[l] * pass.values[l];
      z.colwise() += biases_[l];
      if (l + 1 < count) {
        pass.slopes[l] = (z.array().square() + 1).sqrt().inverse();
        z.array() *= pass.slopes[l].array();
        pass.slopes[l] = pass.slopes[l].array().cube().eval();
      } else {
        const Matrix q = (z.array().square() + 1).sqrt();
        z = (z.array() > 0).select((z + q).array(), (q - z).array().inverse());
        pass.slopes[l] = z.array() / q.array();
      }
    }
  }

  /// Adds to `gradient`, given the weights of the outputs.
  void backward(const Pass& pass, Matrix weight, const Shape& shape, double* gradient) const {
    for (std::size_t l = weights_.size(); l-- > 0;) {
      weight.array() *= pass.slopes[l].array();
      const int in = shape.sizes[l], out = shape.sizes[l + 1];
      double* const at = gradient + shape.starts[l];
      const Row by_weights = weight * pass.values[l].transpose();
      for (std::ptrdiff_t i = 0; i < std::ptrdiff_t{in} * out; ++i) at[i] += by_weights.data()[i];
      const Eigen::VectorXf by_biases = weight.rowwise().sum();
      for (int i = 0; i < out; ++i) at[std::ptrdiff_t{in} * out + i] += by_biases[i];
      if (l > 0) weight = (weights_[l].transpose() * weight).eval();
    }
  }

 private:
  std::vector<Row> weights_;
  std::vector<Eigen::VectorXf> biases_;
};

class Cost final : public solvers::SmoothFunction {
 public:
  Cost(const TrainerData& data, const TrainerOptions& options, const Shape& shape)
      : data_(data), options_(options), shape_(shape), pixels_(data.image.size()),
        precision_(data.y.size(), 1.0F) {}

  int size() const override { return static_cast<int>(shape_.numbers); }

  bool evaluate(const double* numbers, double* cost, double* gradient) const override {
    const Net net(shape_, numbers);
    constexpr std::size_t part_pixels = pixels_at_once * at_once_in_a_part;
    const std::size_t parts = (pixels_ + part_pixels - 1) / part_pixels;
    struct Part {
      double cost = 0;
      std::vector<double> gradient;
    };
    std::vector<Part> done(parts);
    parallel_for(parts, resolve_threads(options_.threads), [&](std::size_t p, int) {
      Part& part = done[p];
      if (gradient) part.gradient.assign(shape_.numbers, 0.0);
      Net::Pass pass;
      const std::size_t end = std::min(pixels_, (p + 1) * part_pixels);
      for (std::size_t first = p * part_pixels; first < end; first += pixels_at_once)
        add(net, first, std::min(pixels_at_once, end - first), pass, part.cost,
            gradient ? part.gradient.data() : nullptr);
    });
    const double share = 1.0 / static_cast<double>(data_.y.size());
    *cost = 0;
    for (const Part& part : done) *cost += share * part.cost;
    residual_ = *cost;
    for (std::size_t i = 0; i < shape_.numbers; ++i)
      *cost += options_.decay * numbers[i] * numbers[i];
    if (gradient) {
      for (std::size_t i = 0; i < shape_.numbers; ++i) {
        gradient[i] = 2 * options_.decay * numbers[i];
        for (const Part& part : done) gradient[i] += share * part.gradient[i];
      }
    }
    return std::isfinite(*cost);
  }

  /// Sets the standard deviations of residuals from the network's current outputs. Those of the
  /// noisy signals would favour pixels that happen to be dark.
  void weigh(const double* numbers) {
    if (!data_.has_noise) return;
    const Net net(shape_, numbers);
    const int outputs = data_.outputs;
    Net::Pass pass;
    for (std::size_t first = 0; first < pixels_; first += pixels_at_once) {
      const std::size_t count = std::min(pixels_at_once, pixels_ - first);
      take(first, count, pass);
      net.forward(pass);
      for (std::size_t i = 0; i < count; ++i)
        for (int c = 0; c < outputs; ++c) {
          const double signal =
              std::max<double>(pass.values.back()(c, static_cast<Eigen::Index>(i)), faintest);
          const double miss = data_.tolerance * signal;
          const double variance =
              data_.noise[data_.image[first + i] * std::size_t(outputs) + c] * signal + miss * miss;
          precision_[(first + i) * outputs + c] = static_cast<float>(1 / std::max(variance, 1e-8));
        }
    }
  }

  double residual() const { return residual_; }

 private:
  void take(std::size_t first, std::size_t count, Net::Pass& pass) const {
    pass.values.resize(1);
    pass.values[0] = Eigen::Map<const Matrix>(data_.x.data() + first * data_.inputs, data_.inputs,
                                              static_cast<Eigen::Index>(count));
  }

  void add(const Net& net, std::size_t first, std::size_t count, Net::Pass& pass, double& cost,
           double* gradient) const {
    const auto columns = static_cast<Eigen::Index>(count);
    take(first, count, pass);
    net.forward(pass);
    const Eigen::Map<const Matrix> y(data_.y.data() + first * data_.outputs, data_.outputs,
                                     columns);
    const Eigen::Map<const Matrix> precision(precision_.data() + first * data_.outputs,
                                             data_.outputs, columns);
    const Matrix error = pass.values.back() - y;
    const Matrix weighted = error.array() * precision.array();
    cost += (weighted.array() * error.array()).cast<double>().sum();
    if (gradient) net.backward(pass, 2 * weighted, shape_, gradient);
  }

  const TrainerData& data_;
  const TrainerOptions& options_;
  const Shape& shape_;
  std::size_t pixels_;
  std::vector<float> precision_;  // 1 / variance of each residual
  mutable double residual_ = 0;
};

}  // namespace

TrainerResult train_network(const TrainerData& data, const TrainerOptions& options,
                            std::vector<DenseLayer>& layers) {
  const Shape shape = shape_of(layers);
  std::vector<double> numbers;
  for (const DenseLayer& layer : layers) {
    numbers.insert(numbers.end(), layer.weights.begin(), layer.weights.end());
    numbers.insert(numbers.end(), layer.biases.begin(), layer.biases.end());
  }
  Cost cost(data, options, shape);
  solvers::MinimiseOptions how;
  how.search = solvers::Search::lbfgs;
  how.lbfgs_rank = lbfgs_rank;
  how.function_tolerance = 1e-8;
  how.gradient_tolerance = 1e-9;
  how.parameter_tolerance = 1e-12;

  TrainerResult result;
  // The first round gives rough standard deviations, the second round better ones, and the last
  // round uses them.
  constexpr double shares[] = {0.15, 0.25, 0.6};
  for (const double share : shares) {
    if (share != shares[0]) cost.weigh(numbers.data());
    how.most_iterations = share == shares[2] ? options.iterations - result.iterations
                                             : static_cast<int>(share * options.iterations);
    if (how.most_iterations == 0) continue;
    const int before = result.iterations;
    std::exception_ptr interrupted;
    how.after = [&](int iteration, double) {
      try {
        options.watch.report(before + iteration, options.iterations);
      } catch (const Interrupted&) {
        interrupted = std::current_exception();
        return solvers::Then::stop;
      }
      return solvers::Then::go_on;
    };
    result.iterations += solvers::minimise(cost, numbers, how).iterations;
    if (interrupted) std::rethrow_exception(interrupted);
  }
  double total = 0;
  cost.evaluate(numbers.data(), &total, nullptr);
  result.cost = cost.residual();

  const double* at = numbers.data();
  for (DenseLayer& layer : layers) {
    std::copy_n(at, layer.weights.size(), layer.weights.begin());
    at += layer.weights.size();
    std::copy_n(at, layer.biases.size(), layer.biases.begin());
    at += layer.biases.size();
  }
  return result;
}

}  // namespace surf
