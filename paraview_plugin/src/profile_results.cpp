// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_results.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "convert/arrays.h"
#include "convert/table.h"

namespace surf::pv {
namespace {

using workflow::ProfileJob;
using workflow::ProfileSummary;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Numbers {
  std::vector<std::string> names;
  std::vector<double> values, errors;

  void add(const std::string& name, double value, double error = nan) {
    names.push_back(name);
    values.push_back(value);
    errors.push_back(error);
  }
  void add(const std::string& name, const Measured& m) { add(name, m.value, m.standard_error); }

  void add_wall(const std::string& side, const std::array<Measured, profile_numbers>& wall) {
    add(side + "height_nm", wall[profile_height]);
    add(side + "angle_deg", wall[profile_angle]);
    add(side + "top_radius_nm", wall[profile_top]);
    add(side + "foot_radius_nm", wall[profile_foot]);
  }

  void add_each(const std::string& name, const std::vector<Measured>& of_features) {
    for (std::size_t i = 0; i < of_features.size(); ++i)
      add(of_features.size() == 1 ? name + "_nm" : fmt::format("{}_{}_nm", name, i + 1),
          of_features[i]);
  }

  void add_roughness(const std::string& of, const EdgeRoughness& r) {
    add(of + "_three_sigma_nm", 3 * r.sigma_nm, 3 * r.sigma_error_nm);
    add(of + "_three_sigma_with_noise_nm", 3 * r.biased_sigma_nm);
    add(of + "_correlation_length_nm", r.correlation_nm);
    add(of + "_hurst_exponent", r.hurst);
    add(of + "_noise_of_a_place_nm", r.noise_nm);
    add(of + "_more_than_noise", r.found);
  }
};

/// Of its feature: the wall at the left of a line has the material at its right, that at the left
/// of a gap the other way round.
const char* wall_name(const ProfileJob& job, const MeanProfile& m) {
  return m.material_right == (job.kind != FeatureKind::trench) ? "left" : "right";
}

double place_by_threshold(const ProfileSummary& s, std::size_t edge, std::size_t row) {
  const auto& places = s.threshold.places_nm[edge];
  return !s.hole && row < places.size() ? places[row] : nan;  // a hole's are of other directions
}

double place(const FittedEdge& e, std::size_t row) {
  return std::isfinite(e.errors_nm[row]) ? e.rows_nm[row] : nan;
}

double error(const FittedEdge& e, std::size_t row) {
  return std::isfinite(e.errors_nm[row]) ? e.errors_nm[row] : nan;
}

template <class Array, class Value>
void add_array(vtkPolyData* data, const char* name, std::vector<Value> values, const char* unit) {
  const auto array = take_array<Array>(std::move(values), name);
  set_unit(array, unit);
  data->GetPointData()->AddArray(array);
}

}  // namespace

void fill_numbers(vtkTable* table, const ProfileJob& job, const ProfileSummary& s) {
  Numbers n;
  if (job.kind != FeatureKind::edge) n.add("width_nm", s.fit.left[profile_width]);
  if (job.walls_apart) {
    n.add_wall("left_", s.fit.left);
    n.add_wall("right_", s.fit.right);
  } else {
    n.add_wall("", s.fit.left);
  }
  if (s.measured_pitch_nm) n.add("pitch_nm", *s.measured_pitch_nm);
  if (s.fit.widths_nm.size() > 1) n.add_each("width", s.fit.widths_nm);
  n.add_each("threshold_width", s.threshold_widths_nm);
  if (s.scan_height_nm) n.add("scan_height_nm", *s.scan_height_nm);
  if (s.hole) {
    n.add("hole_x_nm", s.hole->x_nm);
    n.add("hole_y_nm", s.hole->y_nm);
  }
  if (!s.fit.edge_spectrum.density_nm3.empty()) n.add_roughness("edge", s.fit.edge_roughness);
  if (!s.fit.width_spectrum.density_nm3.empty()) n.add_roughness("width", s.fit.width_roughness);
  for (std::size_t k = 0; k < s.fit.sights.size(); ++k) {
    const SightFit& sight = s.fit.sights[k];
    const std::string of = k == 0 ? "" : fmt::format("view_{}_", k + 1);
    if (k > 0) n.add(of + "tilt_deg", sight.tilt_deg);
    n.add(of + "gain", sight.gain);
    n.add(of + "offset", sight.offset);
    n.add(of + "unexplained_share", sight.discrepancy_share);
  }
  n.add("simulated_pitch_nm", s.pitch_nm);
  n.add("simulated_profiles", static_cast<double>(s.simulated));
  n.add("trusted", s.reasons.empty());
  add_column(table, "quantity", n.names);
  add_column(table, "value", std::move(n.values));
  add_column(table, "standard_error", std::move(n.errors));
}

void fill_rows(vtkTable* table, const ProfileSummary& s) {
  const std::vector<FittedEdge>& edges = s.fit.edges();
  const std::size_t count = edges.front().rows_nm.size();
  std::vector<int> numbers;
  std::vector<double> along;
  for (std::size_t r = 0; r < count; ++r) {
    numbers.push_back(static_cast<int>(r));
    along.push_back(static_cast<double>(r) * s.row_distance_nm);
  }
  add_column(table, "row", std::move(numbers));
  add_column(table, "along_nm", std::move(along));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::vector<double> places, errors, thresholds;
    for (std::size_t r = 0; r < count; ++r) {
      places.push_back(place(edges[e], r));
      errors.push_back(error(edges[e], r));
      thresholds.push_back(place_by_threshold(s, e, r));
    }
    const std::string name = fmt::format("edge_{}", e + 1);
    add_column(table, name + "_nm", std::move(places));
    add_column(table, name + "_error_nm", std::move(errors));
    add_column(table, name + "_threshold_nm", std::move(thresholds));
  }
}

void fill_profiles(vtkTable* table, const ProfileJob& job, const ProfileSummary& s) {
  struct Wall {
    std::string name;
    const MeanProfile* profile;
  };
  std::vector<Wall> walls;
  std::vector<double> u;
  for (std::size_t k = 0; k < s.fit.sights.size(); ++k) {
    const std::vector<MeanProfile>& of_image = s.fit.sights[k].profiles;
    for (const MeanProfile& m : of_image) {
      std::string name = k == 0 ? "" : fmt::format("view_{}_", k + 1);
      if (of_image.size() > 1) name += wall_name(job, m) + std::string("_");
      walls.push_back({name, &m});
      u.insert(u.end(), m.u_nm.begin(), m.u_nm.end());
    }
  }
  const std::size_t count = u.size();
  add_column(table, "u_nm", std::move(u));
  std::size_t first = 0;
  for (const auto& [name, m] : walls) {
    for (const auto& [what, values] :
         {std::pair{"measured", &m->measured}, std::pair{"standard_error", &m->standard_error},
          std::pair{"fitted", &m->fitted}}) {
      std::vector<double> column(count, nan);
      std::ranges::copy(*values, column.begin() + static_cast<std::ptrdiff_t>(first));
      add_column(table, name + what, std::move(column));
    }
    first += m->u_nm.size();
  }
}

void fill_roughness(vtkTable* table, const ProfileSummary& s) {
  const EdgeSpectrum& edges = s.fit.edge_spectrum;
  std::vector<double> fitted, widths = s.fit.width_spectrum.density_nm3;
  for (const double f : edges.frequency_per_nm)
    fitted.push_back(roughness_density(s.fit.edge_roughness, f, s.row_distance_nm));
  widths.resize(fitted.size(), nan);
  add_column(table, "frequency_per_nm", edges.frequency_per_nm);
  add_column(table, "edge_density_nm3", edges.density_nm3);
  add_column(table, "edge_fitted_nm3", std::move(fitted));
  add_column(table, "width_density_nm3", std::move(widths));
}

vtkSmartPointer<vtkPolyData> edge_lines(const ProfileSummary& s) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  std::vector<int> edge, row;
  std::vector<double> places, errors, thresholds;
  const std::vector<FittedEdge>& edges = s.fit.edges();
  const double top = std::max(s.fit.left[profile_height].value, s.fit.right[profile_height].value);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t count = edges[e].rows_nm.size();
    std::vector<vtkIdType> line, begun;
    const auto end_line = [&] {
      if (line.size() > 1) lines->InsertNextCell(static_cast<vtkIdType>(line.size()), line.data());
      line.clear();
    };
    for (std::size_t r = 0; r < count; ++r) {
      if (!std::isfinite(place(edges[e], r))) {
        end_line();
        continue;
      }
      const Point2 at = s.edge_lines_nm[e][r];
      line.push_back(points->InsertNextPoint(at.x, at.y, top));
      if (s.hole && r == 0) begun = line;
      edge.push_back(static_cast<int>(e) + 1);
      row.push_back(static_cast<int>(r));
      places.push_back(place(edges[e], r));
      errors.push_back(error(edges[e], r));
      thresholds.push_back(place_by_threshold(s, e, r));
    }
    if (!line.empty() && !begun.empty()) line.push_back(begun.front());
    end_line();
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  add_array<vtkIntArray>(data, "edge", std::move(edge), "1");
  add_array<vtkIntArray>(data, "row", std::move(row), "1");
  add_array<vtkDoubleArray>(data, "place_nm", std::move(places), "nm");
  add_array<vtkDoubleArray>(data, "error_nm", std::move(errors), "nm");
  add_array<vtkDoubleArray>(data, "threshold_nm", std::move(thresholds), "nm");
  return data;
}

}  // namespace surf::pv
