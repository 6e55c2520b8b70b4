// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/align_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "compare/robust.h"
#include "core/cubic_sample.h"

namespace surf {
namespace {

constexpr int numbers = 5;  // shift x, shift y, lift, tilt x, tilt y
using Vector = std::array<double, numbers>;
using Matrix = std::array<Vector, numbers>;

/// The inverse of a symmetric matrix, if it is positive definite by more than rounding.
std::optional<Matrix> inverse(const Matrix& a) {
  constexpr double rounding = 1e-12;
  Matrix l{}, out{};
  for (int j = 0; j < numbers; ++j) {
    double d = a[j][j];
    for (int k = 0; k < j; ++k) d -= l[j][k] * l[j][k];
    if (!(d > rounding * a[j][j])) return std::nullopt;
    l[j][j] = std::sqrt(d);
    for (int i = j + 1; i < numbers; ++i) {
      double s = a[i][j];
      for (int k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
      l[i][j] = s / l[j][j];
    }
  }
  for (int c = 0; c < numbers; ++c) {
    Vector x{};
    for (int i = 0; i < numbers; ++i) {
      double s = i == c;
      for (int k = 0; k < i; ++k) s -= l[i][k] * x[k];
      x[i] = s / l[i][i];
    }
    for (int i = numbers - 1; i >= 0; --i) {
      double s = x[i];
      for (int k = i + 1; k < numbers; ++k) s -= l[k][i] * x[k];
      x[i] = s / l[i][i];
    }
    for (int i = 0; i < numbers; ++i) out[i][c] = x[i];
  }
  return out;
}

Vector times(const Matrix& m, const Vector& v) {
  Vector out{};
  for (int i = 0; i < numbers; ++i)
    for (int k = 0; k < numbers; ++k) out[i] += m[i][k] * v[k];
  return out;
}

Matrix times(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (int i = 0; i < numbers; ++i)
    for (int k = 0; k < numbers; ++k)
      for (int j = 0; j < numbers; ++j) out[i][j] += a[i][k] * b[k][j];
  return out;
}

void add_outer(Matrix& to, const Vector& v, double weight) {
  for (int i = 0; i < numbers; ++i)
    for (int k = 0; k < numbers; ++k) to[i][k] += weight * v[i] * v[k];
}

struct Sample {
  double residual = 0, slope = 0;  // slope per diagonal of a pixel, for the place's error
  double before = 0, after = 0;
  Vector change{};  // of the residual by the numbers
  int block = 0;
};

/// The tuning constants have 95 % efficiency for normal errors (Huber 1981, Beaton and Tukey 1974,
/// doi:10.1080/00401706.1974.10489171).
double huber_weight(double r) { return std::abs(r) < 1.345 ? 1 : 1.345 / std::abs(r); }
constexpr double tukey = 4.685;
double tukey_weight(double r) {
  const double t = 1 - r * r / (tukey * tukey);
  return std::abs(r) < tukey ? t * t : 0;
}
double tukey_slope(double r) {
  const double q = r * r / (tukey * tukey);
  return q < 1 ? (1 - q) * (1 - 5 * q) : 0;
}

class Fit {
 public:
  Fit(const HeightField& before, const HeightField& after, bool held)
      : before_(before), after_(after), held_(held), w_(before.z_nm.width()),
        h_(before.z_nm.height()), blocks_across_((w_ + block_px - 1) / block_px) {
    half_x_ = 0.5 * (w_ - 1) * before.pitch_x_nm;
    half_y_ = 0.5 * (h_ - 1) * before.pitch_y_nm;
    centre_ = before.place_nm(0.5 * (w_ - 1), 0.5 * (h_ - 1));
  }

  AlignFit run(Point2 start, const Watch& watch) {
    AlignFit out;
    out.pitch = before_.pitch();
    out.centre_nm = centre_;
    Vector at{start.x, start.y, 0, 0, 0};
    bool determined = true;
    for (int step = 0; step < most_steps; ++step) {
      watch.check();
      take_samples(at);
      if (samples_.size() < fewest_samples) return out;
      set_deviations(std::pow(0.5, step));
      Matrix normal{};
      Vector gradient{};
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const double r = samples_[i].residual / deviations_[i];
        const double weight = (step < huber_steps ? huber_weight(r) : tukey_weight(r)) /
                              (deviations_[i] * deviations_[i]);
        add_outer(normal, samples_[i].change, weight);
        for (int k = 0; k < numbers; ++k)
          gradient[k] += weight * samples_[i].change[k] * samples_[i].residual;
      }
      if (held_) normal[0][0] = normal[1][1] = 1;
      auto solved = inverse(normal);
      if (!solved) {  // nothing tells the shift
        determined = false;
        normal[0][0] += 1, normal[1][1] += 1;
        normal[0][1] = normal[1][0] = 0;
        for (int k = 2; k < numbers; ++k)
          normal[0][k] = normal[k][0] = normal[1][k] = normal[k][1] = 0;
        gradient[0] = gradient[1] = 0;
        solved = inverse(normal);
        if (!solved) return out;
      }
      Vector move = times(*solved, gradient);
      for (double& m : move) m = -m;
      // Linear slopes hold within a pixel.
      const double most = std::max(
          {1.0, std::abs(move[0]) / before_.pitch_x_nm, std::abs(move[1]) / before_.pitch_y_nm});
      for (int k = 0; k < numbers; ++k) at[k] += k < 2 ? move[k] / most : move[k];
      const double moved_px =
          std::max(std::abs(move[0]) / before_.pitch_x_nm, std::abs(move[1]) / before_.pitch_y_nm);
      if (step > least_steps && moved_px < settled_px) break;
    }
    take_samples(at);
    if (samples_.size() < fewest_samples) return out;
    set_deviations(0);
    out.usable = true;
    out.place_error_px = place_px_;
    out.shift_nm = {at[0], at[1]};
    out.lift_nm = at[2];
    out.tilt_x = at[3] / half_x_, out.tilt_y = at[4] / half_y_;
    out.overlap = double(samples_.size()) / double(std::max<std::size_t>(count_before(), 1));
    set_correlation(out);
    set_covariance(out);
    if (!held_) {
      constexpr double most_px = 0.5;
      out.determined = determined && std::sqrt(out.covariance[0]) < most_px * before_.pitch_x_nm &&
                       std::sqrt(out.covariance[6]) < most_px * before_.pitch_y_nm;
    }
    return out;
  }

 private:
  static constexpr int most_steps = 40, huber_steps = 5, least_steps = 8, block_px = 16;
  static constexpr std::size_t fewest_samples = 64;
  // The least that places of walls, and the shift, are taken to be known to.
  static constexpr double least_place_px = 0.05, least_error_px = 0.01, settled_px = 1e-5;

  std::size_t count_before() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < before_.z_nm.size(); ++i) n += before_.valid.includes(i);
    return n;
  }

  void take_samples(const Vector& at) {
    samples_.clear();
    const int aw = after_.z_nm.width(), ah = after_.z_nm.height();
    for (int y = 0; y < h_; ++y)
      for (int x = 0; x < w_; ++x) {
        if (!before_.is_valid(x, y)) continue;
        const double u = (before_.x_nm(x) - at[0] - after_.origin_x_nm) / after_.pitch_x_nm,
                     v = (before_.y_nm(y) - at[1] - after_.origin_y_nm) / after_.pitch_y_nm;
        if (!(u >= 0 && v >= 0 && u <= aw - 1 && v <= ah - 1)) continue;
        const CubicSample place(u, v, aw, ah);
        bool whole = true;
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i)
            whole = whole && after_.is_valid(place.column[i], place.row[j]);
        if (!whole) continue;
        const double gx = held_ ? 0 : place.slope_x(after_.z_nm) / after_.pitch_x_nm,
                     gy = held_ ? 0 : place.slope_y(after_.z_nm) / after_.pitch_y_nm;
        const double tx = (before_.x_nm(x) - centre_.x) / half_x_,
                     ty = (before_.y_nm(y) - centre_.y) / half_y_;
        Sample s;
        s.before = before_.z_nm(x, y);
        s.after = place.value(after_.z_nm);
        s.residual = s.after - s.before - at[2] - at[3] * tx - at[4] * ty;
        s.slope = std::hypot(gx * before_.pitch_x_nm, gy * before_.pitch_y_nm);
        s.change = {-gx, -gy, -1, -tx, -ty};
        s.block = y / block_px * blocks_across_ + x / block_px;
        samples_.push_back(s);
      }
  }

  /// Of residuals: noise by the flatter half of the samples, and places of walls by the steep ones.
  void set_deviations(double start_px) {
    constexpr double steep = 4;  // what a pixel of it rises, over the noise
    constexpr std::size_t fewest_steep = 20;
    std::vector<double> slopes, flat, places;
    for (const Sample& s : samples_) slopes.push_back(s.slope);
    const double limit = median(slopes);
    double largest = 0;
    for (const Sample& s : samples_) {
      if (s.slope <= limit) flat.push_back(s.residual);
      largest = std::max(largest, std::abs(s.before) + std::abs(s.after));
    }
    constexpr double rounding = 1e-9;
    const double noise = std::max({robust_deviation(flat), rounding * largest, 1e-30});
    for (const Sample& s : samples_)
      if (s.slope > steep * noise && s.slope > limit)
        places.push_back(std::abs(s.residual) / s.slope);
    place_px_ = places.size() < fewest_steep ? 0 : 1.4826 * median(places);
    const double place_px = std::max({least_place_px, start_px, place_px_});
    deviations_.clear();
    for (const Sample& s : samples_) deviations_.push_back(std::hypot(noise, place_px * s.slope));
  }

  void set_correlation(AlignFit& out) const {
    const double n = double(samples_.size());
    std::array<std::vector<double>, 2> values;
    for (const Sample& s : samples_) values[0].push_back(s.before), values[1].push_back(s.after);
    for (std::vector<double>& v : values) {
      // Tilt coordinates are in `change`, with the sign turned.
      double m[3][4] = {};
      for (std::size_t i = 0; i < v.size(); ++i) {
        const double t[3] = {1, samples_[i].change[3], samples_[i].change[4]};
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) m[r][c] += t[r] * t[c];
          m[r][3] += t[r] * v[i];
        }
      }
      for (int k = 0; k < 3; ++k)
        for (int r = k + 1; r < 3 && m[k][k] > 0; ++r) {
          const double f = m[r][k] / m[k][k];
          for (int c = k; c < 4; ++c) m[r][c] -= f * m[k][c];
        }
      double plane[3] = {};
      for (int k = 2; k >= 0; --k) {
        double s = m[k][3];
        for (int c = k + 1; c < 3; ++c) s -= m[k][c] * plane[c];
        plane[k] = m[k][k] > 1e-12 * n ? s / m[k][k] : 0;
      }
      for (std::size_t i = 0; i < v.size(); ++i)
        v[i] -= plane[0] + plane[1] * samples_[i].change[3] + plane[2] * samples_[i].change[4];
    }
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      ab += values[0][i] * values[1][i];
      aa += values[0][i] * values[0][i];
      bb += values[1][i] * values[1][i];
    }
    out.correlation = aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
    Grid<double> z = before_.z_nm;
    take_plane_off(z, before_.valid);
    out.independent = n / (length_of(z, true) * length_of(z, false));
  }

  /// 1 + 2 sum of squared correlations at all distances along an axis (Bartlett 1946,
  /// doi:10.2307/2983611), of some of the lines.
  double length_of(const Grid<double>& z, bool along_x) const {
    constexpr int most_lines = 48, farthest = 256;
    const int lines = along_x ? h_ : w_, length = along_x ? w_ : h_;
    const int skip = std::max(1, lines / most_lines);
    const int reach = std::min(length / 2, farthest);
    std::vector<double> sums(std::size_t(reach) + 1), pairs(std::size_t(reach) + 1);
    for (int line = 0; line < lines; line += skip)
      for (int i = 0; i < length; ++i) {
        const int x = along_x ? i : line, y = along_x ? line : i;
        if (!before_.is_valid(x, y)) continue;
        for (int k = 0; k <= reach && i + k < length; ++k) {
          const int u = along_x ? i + k : line, v = along_x ? line : i + k;
          if (!before_.is_valid(u, v)) continue;
          sums[std::size_t(k)] += z(x, y) * z(u, v), ++pairs[std::size_t(k)];
        }
      }
    double out = 1;
    if (!(pairs[0] > 0 && sums[0] > 0)) return out;
    const double variance = sums[0] / pairs[0];
    for (std::size_t k = 1; k < sums.size(); ++k) {
      if (!(pairs[k] > 0)) continue;
      const double c = std::clamp(sums[k] / pairs[k] / variance, -1.0, 1.0);
      out += 2 * c * c;
    }
    return out;
  }

  void set_covariance(AlignFit& out) const {
    Matrix bread{}, robust{}, meat{};
    const int blocks = blocks_across_ * ((h_ + block_px - 1) / block_px);
    std::vector<Vector> scores(static_cast<std::size_t>(blocks));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& s = samples_[i];
      const double d = deviations_[i], r = s.residual / d;
      add_outer(bread, s.change, tukey_slope(r) / (d * d));
      add_outer(robust, s.change, tukey_weight(r) / (d * d));
      for (int k = 0; k < numbers; ++k)
        scores[std::size_t(s.block)][k] += tukey_weight(r) * r / d * s.change[k];
    }
    for (const Vector& score : scores) add_outer(meat, score, 1);
    if (held_) {
      for (Matrix* m : {&bread, &robust}) (*m)[0][0] = (*m)[1][1] = 1;
    }
    auto inner = inverse(bread);
    if (!inner) inner = inverse(robust);
    if (!inner) {
      out.covariance[0] = out.covariance[6] = HUGE_VAL;
      return;
    }
    Matrix c = times(times(*inner, meat), *inner);
    if (held_)
      for (int k = 0; k < numbers; ++k) c[0][k] = c[k][0] = c[1][k] = c[k][1] = 0;
    else
      c[0][0] += std::pow(least_error_px * before_.pitch_x_nm, 2),
          c[1][1] += std::pow(least_error_px * before_.pitch_y_nm, 2);
    const Vector unit{1, 1, 1, 1 / half_x_, 1 / half_y_};
    for (int i = 0; i < numbers; ++i)
      for (int k = 0; k < numbers; ++k)
        out.covariance[std::size_t(numbers * i + k)] = c[i][k] * unit[i] * unit[k];
  }

  const HeightField &before_, &after_;
  bool held_;
  int w_, h_, blocks_across_;
  double half_x_ = 1, half_y_ = 1;
  Point2 centre_;
  std::vector<Sample> samples_;
  std::vector<double> deviations_;
  double place_px_ = 0;  // by which walls are off their places
};

/// Sums of values and weights along one axis, by a Gaussian.
void blur(Grid<double>& grid, double sigma_px, bool along_x) {
  const int reach = int(std::ceil(3 * sigma_px));
  std::vector<double> kernel;
  double total = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
    total += kernel.back();
  }
  for (double& k : kernel) k /= total;
  const int lines = along_x ? grid.height() : grid.width(),
            length = along_x ? grid.width() : grid.height();
  std::vector<double> line(static_cast<std::size_t>(length));
  for (int j = 0; j < lines; ++j) {
    for (int i = 0; i < length; ++i) line[std::size_t(i)] = along_x ? grid(i, j) : grid(j, i);
    for (int i = 0; i < length; ++i) {
      double sum = 0;
      for (int k = std::max(-reach, -i); k <= std::min(reach, length - 1 - i); ++k)
        sum += kernel[std::size_t(k + reach)] * line[std::size_t(i + k)];
      (along_x ? grid(i, j) : grid(j, i)) = sum;
    }
  }
}

}  // namespace

HeightField smoothed(const HeightField& field, double sigma_x_nm, double sigma_y_nm) {
  constexpr double whole = 1 - 1e-6;
  HeightField out = field;
  Grid<double> weights(field.z_nm.width(), field.z_nm.height());
  out.valid = Mask(field.z_nm.width(), field.z_nm.height());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights.data()[i] = field.valid.includes(i) ? 1 : 0;
    if (!field.valid.includes(i)) out.z_nm.data()[i] = 0;
  }
  for (Grid<double>* grid : {&out.z_nm, &weights}) {
    blur(*grid, sigma_x_nm / field.pitch_x_nm, true);
    blur(*grid, sigma_y_nm / field.pitch_y_nm, false);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    out.valid.data()[i] = weights.data()[i] > whole;
    if (!out.valid.data()[i]) out.z_nm.data()[i] = 0;
  }
  return out;
}

void take_plane_off(Grid<double>& values, const Mask& valid) {
  const int w = values.width(), h = values.height();
  double n = 0, sx = 0, sy = 0, sz = 0;
  const auto each = [&](const auto& use) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        if (valid.includes(x, y)) use(x, y, values(x, y));
  };
  each([&](double x, double y, double z) { ++n, sx += x, sy += y, sz += z; });
  if (n == 0) return;
  const double mx = sx / n, my = sy / n, mz = sz / n;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  each([&](double x, double y, double z) {
    x -= mx, y -= my, z -= mz;
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  });
  const double det = xx * yy - xy * xy;
  const bool tilted = det > 1e-9 * xx * yy;
  const double a = tilted ? (xz * yy - yz * xy) / det : 0,
               b = tilted ? (yz * xx - xz * xy) / det : 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) values(x, y) -= mz + a * (x - mx) + b * (y - my);
}

AlignFit fit_alignment(const HeightField& before, const HeightField& after, Point2 start, bool held,
                       const Watch& watch) {
  return Fit(before, after, held).run(start, watch);
}

}  // namespace surf
