// SPDX-License-Identifier: GPL-3.0-or-later
// What --mesh-tolerance gains and changes, as JSON and as a chart: triangles, time to simplify and
// to build, memory, primaries per second (directly simulated and by replay), and how far SE and BSE
// images, by replay, are from those of all detail. A rough height field and a bumpy ball on a
// substrate, silicon at 1 keV.
//   bench_tolerance [--quick] [output.json [chart.svg]]
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "surf/io/plot.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"
#include "surf/workflow/simplify_specimen.h"

namespace {

using namespace surf;
using nlohmann::json;

mc::Specimen silicon() {
  mc::Specimen s;
  s.materials = {io::find_material("Si", "bench")};
  return s;
}

mc::Specimen rough() {
  mc::Specimen s = silicon();
  s.height_field =
      mc::HeightFieldBody{"rough", make_rough({400, 400, 1}, 5, 20, 1), 0, Edge::periodic};
  return s;
}

mc::Specimen ball() {
  mc::Specimen s = silicon();
  s.substrate = mc::Substrate{};
  TriangleMesh mesh = make_sphere({0, 0, 0}, 100, 6);
  for (Vec3& v : mesh.vertices_nm)
    v = v * (1 + 0.04 * std::sin(v.x / 7) * std::sin(v.y / 8) * std::sin(v.z / 9)) + Vec3{0, 0, 60};
  s.bodies = {{"ball", mesh, 0}};
  return s;
}

struct View {
  mc::Scan scan;
  int pixels;
  std::int64_t electrons;
};

mc::SimulationResult image(const mc::Scene& scene, const View& view, std::uint64_t seed) {
  mc::SimulationOptions o;
  o.method = mc::Method::replay;
  o.budget = mc::ElectronsPerPixel{view.electrons};
  o.seed = seed;
  return mc::simulate(scene, o);
}

double direct_per_second(const mc::Scene& scene) {
  mc::SimulationOptions o;
  o.budget = mc::ElectronsPerPixel{60};
  const mc::SimulationResult r = mc::simulate(scene, o);
  return static_cast<double>(r.balance.incident) / r.seconds;
}

// Root-mean-square difference of two images beyond their scatter, and what of it could be chance.
struct Difference {
  double rms, noise, of_means;  // relative to the mean of the first
};

Difference difference(const mc::SimulationResult& a, const mc::SimulationResult& b, std::size_t d,
                      int pixels) {
  double mean = 0, squares = 0, variance = 0, sum = 0;
  const double n = double(pixels) * pixels;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      const mc::Estimate p = a.yield(d, x, y), q = b.yield(d, x, y);
      mean += p.mean / n;
      sum += (q.mean - p.mean) / n;
      squares += (q.mean - p.mean) * (q.mean - p.mean) / n;
      variance += (p.standard_error * p.standard_error + q.standard_error * q.standard_error) / n;
    }
  // The mean of n squares scatters by sqrt(2 / n) of itself; two such deviations are chance.
  return {std::sqrt(std::max(0.0, squares - variance)) / mean,
          std::sqrt(variance * 2 * std::sqrt(2 / n)) / mean, sum / mean};
}

json sweep(const char* name, const mc::Specimen& all, const View& view,
           const std::vector<double>& tolerances) {
  const mc::Scene full(all, {}, view.scan);
  const mc::SimulationResult reference = image(full, view, 1);
  json rows;
  std::uint64_t seed = 1;
  for (const double tolerance : tolerances) {
    workflow::Simplification done;
    const mc::Specimen simple =
        tolerance > 0 ? workflow::simplify_specimen(all, tolerance, {}, view.scan, {}, 0, done)
                      : all;
    const mc::Scene scene(simple, {}, view.scan);
    const mc::SimulationResult result = image(scene, view, ++seed);
    const auto incident = static_cast<double>(result.balance.incident);
    json row{{"tolerance_nm", tolerance},
             {"triangles", scene.summary().triangles},
             {"deviation_nm", done.bodies.empty() ? 0.0 : done.bodies[0].deviation_nm},
             {"simplify_seconds", done.seconds},
             {"build_seconds", scene.summary().build_seconds},
             {"memory_bytes", scene.summary().memory_bytes},
             {"direct_per_second", direct_per_second(scene)},
             {"replay_per_second", incident / result.seconds},
             {"replay_rays_per_primary", static_cast<double>(result.balance.rays) / incident}};
    for (const std::size_t d : {0u, 1u}) {
      const Difference e = difference(reference, result, d, view.pixels);
      row[result.detectors[d].name] = {{"rms", e.rms}, {"noise", e.noise}, {"mean", e.of_means}};
    }
    fmt::print(stderr, "{} {}\n", name, row.dump());
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<double> column(const json& rows, const json::json_pointer& key) {
  std::vector<double> values;
  for (const json& row : rows)
    if (row["tolerance_nm"] > 0) values.push_back(row[key].get<double>());
  return values;
}

io::Plot chart(const json& out) {
  using Key = json::json_pointer;
  struct Quantity {
    const char* label;
    Key key;
    bool log;
  };
  io::Plot plot;
  plot.title = "Leaving out detail: --mesh-tolerance, silicon at 1 keV";
  plot.columns = 2;
  for (const Quantity& q : {Quantity{"triangles traced", Key("/triangles"), true},
                            {"primaries per second, direct", Key("/direct_per_second"), false},
                            {"time to simplify (s)", Key("/simplify_seconds"), true}}) {
    io::PlotPanel panel;
    panel.x = {"tolerance (nm)", true, {}};
    panel.y = {q.label, q.log, {}};
    for (const auto& [name, rows] : out.items()) {
      io::PlotSeries s;
      s.name = name;
      s.x = column(rows, Key("/tolerance_nm"));
      s.y = column(rows, q.key);
      s.style = io::PlotStyle::line_points;
      panel.series.push_back(std::move(s));
    }
    plot.panels.push_back(std::move(panel));
  }
  io::PlotPanel error;
  error.x = {"tolerance (nm)", true, {}};
  error.y = {"image error, rms / mean (%)", false, {}};
  for (const auto& [name, rows] : out.items())
    for (const char* detector : {"SE", "BSE"}) {
      io::PlotSeries s;
      s.name = fmt::format("{}, {}", name, detector);
      s.x = column(rows, Key("/tolerance_nm"));
      s.y = column(rows, Key(fmt::format("/{}/rms", detector)));
      s.y_error = column(rows, Key(fmt::format("/{}/noise", detector)));
      for (double& y : s.y) y *= 100;
      for (double& e : s.y_error) e *= 100;
      s.style = io::PlotStyle::line_points;
      s.dashed = std::strcmp(detector, "BSE") == 0;
      error.series.push_back(std::move(s));
    }
  plot.panels.push_back(std::move(error));
  return plot;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--quick") == 0) quick = true;
    else files.push_back(argv[i]);
  View view;
  view.pixels = 16;
  view.electrons = quick ? 700 : 5000;
  view.scan.width = view.scan.height = view.pixels;
  view.scan.pixel_x_nm = view.scan.pixel_y_nm = 12;
  const std::vector<double> tolerances =
      quick ? std::vector<double>{0, 0.05, 0.2, 0.5, 1, 2}
            : std::vector<double>{0, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2};
  json out;
  out["rough"] = sweep("rough", rough(), view, tolerances);
  out["ball"] = sweep("ball", ball(), view, tolerances);
  const std::string text = out.dump(2) + "\n";
  if (files.empty()) fmt::print("{}", text);
  else std::ofstream(files[0]) << text;
  if (files.size() > 1) io::write_plot(files[1], chart(out));
}
