// SPDX-License-Identifier: GPL-3.0-or-later
// What a control of higher order would leave of a pixel's variance, as JSON: the same cascades,
// with the same random numbers, on waves and on their Taylor polynomials about the pixel, of first
// order (the tangent plane, which `--accuracy` compares with), second (a quadric) and third. The
// variance of the difference of the counts over that of the counts, averaged over pixels.
//   bench_controls [--quick] [output.json]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenes.h"
#include "surf/mc/simulate.h"

namespace {

using namespace surf;
using nlohmann::json;

// a (sin k x + sin 0.9 k y) about a point, as a polynomial of that order; the waves themselves
// above 3.
mc::Specimen surface(double wavelength_nm, double radius_nm, double x_nm, double y_nm, int order) {
  constexpr double half_width_nm = 150;
  const double pitch_nm = wavelength_nm / 100;
  const double k = 2 * 3.14159265358979324 / wavelength_nm;
  const double height_nm = 1 / (k * k * radius_nm);
  const auto along = [&](double wave_number, double at, double d) {
    if (order > 3) return std::sin(wave_number * (at + d));
    // Farther out polynomials tower over the pixel: level from where the waves have turned.
    if (order > 1) d = std::clamp(d, -wavelength_nm / 4, wavelength_nm / 4);
    const std::array<double, 4> derivatives{std::sin(wave_number * at), std::cos(wave_number * at),
                                            -std::sin(wave_number * at),
                                            -std::cos(wave_number * at)};
    double sum = 0, term = 1;
    for (int n = 0; n <= order; ++n) {
      sum += derivatives[static_cast<std::size_t>(n)] * term;
      term *= wave_number * d / (n + 1);
    }
    return sum;
  };
  const int n = 2 * static_cast<int>(half_width_nm / pitch_nm) + 1;
  HeightField f;
  f.z_nm = Grid<double>(n, n);
  f.pitch_x_nm = f.pitch_y_nm = pitch_nm;
  f.origin_x_nm = f.origin_y_nm = -0.5 * (n - 1) * pitch_nm;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      f.z_nm(i, j) = height_nm * (along(k, x_nm, f.x_nm(i)) + along(0.9 * k, y_nm, f.y_nm(j)));
  mc::Specimen s = bench::only_silicon();
  s.height_field = mc::HeightFieldBody{"surface", f, 0, Edge::flat};
  return s;
}

// Every pixel is one primary at the same place: pixels of two surfaces are the same cascade.
mc::SimulationResult primaries(const mc::Specimen& specimen, double energy_ev, int across) {
  const mc::Scene scene(specimen, bench::beam(energy_ev), bench::view(1e-5, across));
  mc::SimulationOptions o;
  o.method = mc::Method::replay;
  o.budget = mc::ElectronsPerPixel{1};
  return mc::simulate(scene, o);
}

struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double v) { n += 1, sum += v, squares += v * v; }
  double variance() const { return squares / n - sum * sum / (n * n); }
};

json left(double energy_ev, double wavelength_nm, double radius_nm, int points, int across) {
  constexpr int orders = 3;
  json out{{"energy_ev", energy_ev}, {"wavelength_nm", wavelength_nm}, {"radius_nm", radius_nm}};
  std::array<std::array<double, orders>, 2> remains{};
  for (int p = 0; p < points; ++p) {
    // Spread evenly over a wave, by the golden ratio.
    const double x_nm = wavelength_nm * (p + 0.5) / points,
                 y_nm = wavelength_nm * std::fmod(0.618034 * p, 1);
    const auto counts = [&](int order) {
      return primaries(surface(wavelength_nm, radius_nm, x_nm, y_nm, order), energy_ev, across);
    };
    const mc::SimulationResult truth = counts(orders + 1);
    for (int order = 1; order <= orders; ++order) {
      const mc::SimulationResult model = counts(order);
      for (std::size_t d = 0; d < remains.size(); ++d) {
        Moments all, difference;
        for (int y = 0; y < across; ++y)
          for (int x = 0; x < across; ++x) {
            const auto count = static_cast<double>(truth.counts[d](x, y).sum);
            all.add(count);
            difference.add(count - static_cast<double>(model.counts[d](x, y).sum));
          }
        remains[d][static_cast<std::size_t>(order - 1)] +=
            difference.variance() / all.variance() / points;
      }
    }
  }
  out["left"] = {{"SE", remains[0]}, {"BSE", remains[1]}};
  fmt::print(stderr,
             "{} eV, waves of {} nm, radii from {} nm: of SE {:.3f} plane, {:.3f} quadric, {:.3f} "
             "cubic; of BSE {:.3f}, {:.3f}, {:.3f}\n",
             energy_ev, wavelength_nm, radius_nm, remains[0][0], remains[0][1], remains[0][2],
             remains[1][0], remains[1][1], remains[1][2]);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string file;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else file = argv[i];
  }
  json out;
  const int points = quick ? 3 : 6, across = quick ? 48 : 64;
  for (const double energy_ev : {500.0, 1000.0, 2000.0})
    for (const auto& [wavelength_nm, radius_nm] :
         {std::pair{200.0, 250.0}, {120.0, 90.0}, {60.0, 25.0}})
      if (!quick || energy_ev == 1000)
        out.push_back(left(energy_ev, wavelength_nm, radius_nm, points, across));
  const std::string text = out.dump(2) + "\n";
  if (file.empty()) fmt::print("{}", text);
  else std::ofstream(file) << text;
}
