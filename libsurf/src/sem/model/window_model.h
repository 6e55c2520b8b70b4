// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sem/model/model_input.h"
#include "sem/model/padded_field.h"
#include "surf/core/parallel.h"
#include "surf/sem/image_model.h"

// Models in which a pixel is a function of a sum over the surrounding surface of kernel(offset,
// height above the pixel, slope there). A Kernel has
//     int reach() const                               columns to each side
//     std::size_t channels() const
//     WindowTerm term(channel, dx, dy, dz_nm, slope_x, slope_y) const      with its derivatives
//     WindowSignal signal(channel, sum) const                              with its derivative

namespace surf {

/// A term of the sum, and its derivatives by its arguments.
struct WindowTerm {
  double value = 0, by_height = 0, by_slope_x = 0, by_slope_y = 0;
};

struct WindowSignal {
  double value = 0, by_sum = 0;
};

template <class Kernel>
class WindowLinearization final : public Linearization {
 public:
  WindowLinearization(std::shared_ptr<const Kernel> kernel, const HeightField& field,
                      const ModelOptions& options)
      : kernel_(std::move(kernel)), field_(field, kernel_->reach() + 1, options.edge),
        threads_(options.threads) {
    const Grid<double> none(field_.width(), field_.height());
    images_.assign(kernel_->channels(), none);
    by_sum_ = by_own_height_ = images_;
    rows(
        field_.height(),
        [&](int y) {
          for (std::size_t c = 0; c < images_.size(); ++c)
            for (int x = 0; x < field_.width(); ++x) look(c, x, y);
        },
        options.watch);
  }

  const ModelImages& images() const override { return images_; }
  ModelImages take_images() { return std::move(images_); }

  Grid<double> gradient(const ModelImages& weights) const override {
    check_weights(weights, kernel_->channels(), images_.front());
    // Every place, also beyond the edge, collects from the pixels around it, so no two threads
    // write to the same place.
    Grid<double> z = field_.none(), slope_x = z, slope_y = z;
    const int reach = kernel_->reach();
    rows(field_.height() + 2 * reach, [&](int row) {
      const int v = row - reach;
      for (int u = -reach; u < field_.width() + reach; ++u) {
        const WindowTerm sum = collect(weights, u, v);
        field_.at(z, u, v) = sum.by_height;
        field_.at(slope_x, u, v) = sum.by_slope_x;
        field_.at(slope_y, u, v) = sum.by_slope_y;
      }
    });
    for (std::size_t c = 0; c < weights.size(); ++c)
      for (int y = 0; y < field_.height(); ++y)
        for (int x = 0; x < field_.width(); ++x)
          field_.at(z, x, y) -= weights[c](x, y) * by_sum_[c](x, y) * by_own_height_[c](x, y);
    return field_.fold(std::move(z), slope_x, slope_y);
  }

  ModelImages change(const Grid<double>& dz_nm) const override {
    check_change(dz_nm, images_.front());
    const PaddedField step = field_.like(dz_nm);
    ModelImages out(images_.size(), Grid<double>(field_.width(), field_.height()));
    const int reach = kernel_->reach();
    rows(field_.height(), [&](int y) {
      for (std::size_t c = 0; c < out.size(); ++c)
        for (int x = 0; x < field_.width(); ++x) {
          double sum = -by_own_height_[c](x, y) * dz_nm(x, y);
          for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
              const WindowTerm t = term(c, x, y, dx, dy);
              sum += t.by_height * step.z(x + dx, y + dy) +
                     t.by_slope_x * step.slope_x(x + dx, y + dy) +
                     t.by_slope_y * step.slope_y(x + dx, y + dy);
            }
          out[c](x, y) = by_sum_[c](x, y) * sum;
        }
    });
    return out;
  }

 private:
  template <class Work>
  void rows(int count, const Work& work, const Watch& watch = {}) const {
    parallel_for(
        static_cast<std::size_t>(count), threads_,
        [&](std::size_t y, int) { work(static_cast<int>(y)); }, watch);
  }

  WindowTerm term(std::size_t c, int x, int y, int dx, int dy) const {
    return kernel_->term(c, dx, dy, field_.z(x + dx, y + dy) - field_.z(x, y),
                         field_.slope_x(x + dx, y + dy), field_.slope_y(x + dx, y + dy));
  }

  void look(std::size_t c, int x, int y) {
    const int reach = kernel_->reach();
    double sum = 0, own = 0;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const WindowTerm t = term(c, x, y, dx, dy);
        sum += t.value;
        own += t.by_height;
      }
    const WindowSignal s = kernel_->signal(c, sum);
    images_[c](x, y) = s.value;
    by_sum_[c](x, y) = s.by_sum;
    by_own_height_[c](x, y) = own;
  }

  /// The derivatives by the height and the slopes at (u, v), collected from the surrounding pixels.
  WindowTerm collect(const ModelImages& weights, int u, int v) const {
    const int reach = kernel_->reach();
    WindowTerm sum;
    for (std::size_t c = 0; c < weights.size(); ++c)
      for (int y = std::max(v - reach, 0); y <= std::min(v + reach, field_.height() - 1); ++y)
        for (int x = std::max(u - reach, 0); x <= std::min(u + reach, field_.width() - 1); ++x) {
          const double w = weights[c](x, y) * by_sum_[c](x, y);
          if (w == 0) continue;
          const WindowTerm t = term(c, x, y, u - x, v - y);
          sum.by_height += w * t.by_height;
          sum.by_slope_x += w * t.by_slope_x;
          sum.by_slope_y += w * t.by_slope_y;
        }
    return sum;
  }

  std::shared_ptr<const Kernel> kernel_;
  PaddedField field_;
  int threads_;
  ModelImages images_;
  ModelImages by_sum_;  // derivative of the signal by its sum
  // Sum of the terms' derivatives by height; minus this is the derivative by the pixel's own
  // height.
  ModelImages by_own_height_;
};

template <class Kernel>
class WindowModel final : public ImageModel {
 public:
  WindowModel(ModelScope scope, std::vector<std::string> names,
              std::shared_ptr<const Kernel> kernel)
      : scope_(std::move(scope)), names_(std::move(names)), kernel_(std::move(kernel)) {}

  const std::vector<std::string>& channels() const override { return names_; }
  const ModelScope& scope() const override { return scope_; }

  ModelImages predict(const HeightField& field, const ModelOptions& options) const override {
    check_field(scope_, field);
    return WindowLinearization<Kernel>(kernel_, field, options).take_images();
  }
  std::unique_ptr<Linearization> linearize(const HeightField& field,
                                           const ModelOptions& options) const override {
    check_field(scope_, field);
    return std::make_unique<WindowLinearization<Kernel>>(kernel_, field, options);
  }

 private:
  ModelScope scope_;
  std::vector<std::string> names_;
  std::shared_ptr<const Kernel> kernel_;
};

}  // namespace surf
