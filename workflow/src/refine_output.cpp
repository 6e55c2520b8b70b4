// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "refine_images.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/plot.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/section.h"
#include "surf/mesh/triangle_tree.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Json = nlohmann::ordered_json;

/// A piece of the section across the middle, with the deviation there.
struct Piece {
  std::array<Vec3, 2> ends;
  double deviation_nm = 0;
};

/// What images show, as far as beams from above would.
Box view_of(const RefineJob& job) {
  Box out;
  for (const SemInput& input : job.images) {
    const PlacedImage& image = input.image;
    for (const int corner : {0, 1})
      out.extend(Vec3{image.x_nm(corner * (image.values.width() - 1)),
                      image.y_nm(corner * (image.values.height() - 1)), 0});
  }
  return out;
}

double middle_y(const RefineJob& job) {
  return view_of(job).center_nm().y + 0.01;  // not along a row of vertices
}

std::vector<Piece> section_of(const RefineJob& job, const RefineSummary& s) {
  std::vector<Piece> out;
  const TriangleTree tree(s.mesh);
  for (const std::array<Vec3, 2>& ends : section_at_y(s.mesh, middle_y(job))) {
    const Vec3 middle = (ends[0] + ends[1]) * 0.5;
    const Triangle& t = s.mesh.triangles[tree.closest(middle).triangle];
    double sum = 0;
    for (const std::uint32_t corner : t) sum += s.deviation_nm[corner] / 3;
    out.push_back({ends, sum});
  }
  return out;
}

std::string section_csv(const std::vector<Piece>& section) {
  std::string text = "x1_nm,z1_nm,x2_nm,z2_nm,deviation_nm\n";
  for (const Piece& p : section)
    text += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", p.ends[0].x, p.ends[0].z,
                        p.ends[1].x, p.ends[1].z, p.deviation_nm);
  return text;
}

Json report(const RefineJob& job, const RefineSummary& s) {
  Json json = {
      {"semsurf_version", version()},         {"start", job.start_file.filename().string()},
      {"material", job.material.name},        {"vertices", s.mesh.vertices_nm.size()},
      {"triangles", s.mesh.triangles.size()}, {"self_intersections", s.self_intersections},
      {"simulated_primaries", s.primaries}};
  double squares = 0, most = 0, moved = 0;
  for (const double d : s.displacement_nm)
    if (d != 0) ++moved, squares += d * d, most = std::max(most, std::abs(d));
  json["displacement_nm"] = {{"rms", moved > 0 ? std::sqrt(squares / moved) : 0},
                             {"largest", most}};
  for (std::size_t v = 0; v < s.images.size(); ++v) {
    const RefinedImage& image = s.images[v];
    json["images"].push_back({{"file", job.images[v].file.filename().string()},
                              {"signal", of_view(job.signals, v, std::string("SE"))},
                              {"tilt_deg", image.tilt_deg},
                              {"azimuth_deg", image.azimuth_deg},
                              {"shift_x_nm", image.state.shift_x_nm},
                              {"shift_y_nm", image.state.shift_y_nm},
                              {"gain", image.state.gain},
                              {"offset", image.state.offset},
                              {"unexplained_share_before", image.unexplained_before},
                              {"unexplained_share", image.unexplained}});
  }
  json["trusted"] = s.reasons.empty();
  json["reasons"] = s.reasons;
  json["parameters"] = Json::object();
  for (const auto& [key, value] : record_of(job)) json["parameters"][key] = value;
  return json;
}

Grid<float> floats(const Grid<double>& values) {
  Grid<float> out(values.width(), values.height());
  std::ranges::transform(values.data(), out.data().begin(),
                         [](double v) { return static_cast<float>(v); });
  return out;
}

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

SurfaceScene surface_scene(const RefineSummary& s, const std::map<std::string, std::string>& made) {
  Surface surface{"surface", s.mesh, {}, {}};
  surface.scalars.push_back({"deviation", "nm", floats(s.deviation_nm)});
  surface.scalars.push_back({"displacement", "nm", floats(s.displacement_nm)});
  for (std::size_t v = 0; v < s.sensitivity.size(); ++v)
    surface.scalars.push_back(
        {fmt::format("sensitivity_view{}", v + 1), "1/nm", floats(s.sensitivity[v])});
  return {{surface}, {}, made};
}

Image view_image(const RefineJob& job, const RefinedImage& view, std::size_t number,
                 const std::map<std::string, std::string>& made) {
  const PlacedImage& measured = job.images[number].image;
  Image image;
  image.placement() = measured.placement();
  image.metadata = made;
  image.channels = {{"measured", "1", floats(measured.values)},
                    {"simulated", "1", floats(view.simulated)},
                    {"residual", "1", floats(view.residual)},
                    {"sensitivity", "1/nm", floats(view.sensitivity_per_nm)}};
  return image;
}

io::PlotPanel picture(const std::string& title, const PlacedImage& place,
                      const Grid<double>& values, io::PlotColors colors, const std::string& label) {
  io::PlotPanel panel;
  panel.title = title;
  panel.x.label = "x (nm)";
  panel.y.label = "y (nm)";
  io::PlotImage image;
  image.values = values;
  image.pitch_x = place.pitch_x_nm, image.pitch_y = place.pitch_y_nm;
  image.origin_x = place.origin_x_nm, image.origin_y = place.origin_y_nm;
  image.colors = colors;
  image.label = label;
  panel.image = std::move(image);
  return panel;
}

/// Pieces of a section as one series: gaps are where values are not finite, which a series may not
/// have, so that each connected run is a series.
void add_runs(io::PlotPanel& panel, const std::vector<std::array<Vec3, 2>>& pieces,
              const std::string& name, int color, bool dashed) {
  std::vector<std::array<Vec3, 2>> left = pieces;
  constexpr double same = 1e-6;
  bool first = true;
  while (!left.empty()) {
    std::vector<Vec3> run{left.back()[0], left.back()[1]};
    left.pop_back();
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t i = 0; i < left.size(); ++i) {
        const auto joins = [&](const Vec3& end, std::size_t k) {
          return length(end - left[i][k]) < same;
        };
        if (joins(run.back(), 0) || joins(run.back(), 1))
          run.push_back(left[i][joins(run.back(), 0) ? 1 : 0]);
        else if (joins(run.front(), 0) || joins(run.front(), 1))
          run.insert(run.begin(), left[i][joins(run.front(), 0) ? 1 : 0]);
        else continue;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        grown = true;
        break;
      }
    }
    io::PlotSeries line;
    line.name = first ? name : "";
    line.color = color, line.dashed = dashed;
    for (const Vec3& p : run) line.x.push_back(p.x), line.y.push_back(p.z);
    panel.series.push_back(std::move(line));
    first = false;
  }
}

io::PlotPanel section_panel(const RefineJob& job, const RefineSummary& s,
                            const std::vector<Piece>& section) {
  io::PlotPanel panel;
  panel.title = "section across the middle";
  panel.x.label = "x (nm)";
  panel.y.label = "z (nm)";
  const double y = middle_y(job);
  std::vector<std::array<Vec3, 2>> after, out, in;
  for (const Piece& p : section) {
    after.push_back(p.ends);
    // Two deviations to both sides of the surface.
    const Vec3 along = p.ends[1] - p.ends[0];
    const double size = std::hypot(along.x, along.z);
    if (!(size > 0)) continue;
    const Vec3 across = Vec3{along.z, 0, -along.x} * (2 * p.deviation_nm / size);
    out.push_back({p.ends[0] + across, p.ends[1] + across});
    in.push_back({p.ends[0] - across, p.ends[1] - across});
  }
  add_runs(panel, section_at_y(s.before, y), "start", 7, true);
  for (const auto* side : {&out, &in})
    for (const std::array<Vec3, 2>& ends : *side) {
      io::PlotSeries line;
      line.name = side == &out && &ends == &out.front() ? "± 2 standard deviations" : "";
      line.color = 4;
      line.x = {ends[0].x, ends[1].x}, line.y = {ends[0].z, ends[1].z};
      panel.series.push_back(std::move(line));
    }
  add_runs(panel, after, "refined", 0, false);
  const Box view = view_of(job);
  panel.x.range = {view.lower_nm.x, view.upper_nm.x};
  Box shown;
  for (const Vec3& p : s.mesh.vertices_nm)
    if (p.x >= view.lower_nm.x && p.x <= view.upper_nm.x) shown.extend(p);
  if (!shown.empty()) {
    const double beside = 0.1 * (shown.upper_nm.z - shown.lower_nm.z) + 1;
    panel.y.range = {shown.lower_nm.z - beside, shown.upper_nm.z + beside};
  }
  return panel;
}

std::vector<std::filesystem::path> inputs_of(const RefineJob& job) {
  std::vector<std::filesystem::path> files{job.start_file};
  for (const SemInput& image : job.images) files.push_back(image.file);
  return files;
}

}  // namespace

std::vector<std::filesystem::path> write_refined(const RefineJob& job, const RefineSummary& s) {
  std::filesystem::create_directories(job.folder);
  std::vector<std::filesystem::path> written;
  const auto path = [&](const std::string& file) {
    written.push_back(job.folder / file);
    return written.back();
  };
  // Of an earlier run; what says whether a result is to be trusted comes last.
  for (const char* file : {"report.json", "panel.png"}) std::filesystem::remove(job.folder / file);
  const std::map<std::string, std::string> made =
      step_record("refine", record_of(job), inputs_of(job));
  const SurfaceScene scene = surface_scene(s, made);
  io::write_surfaces(path("surface.vtp"), scene);
  io::write_surfaces(path("surface.stl"), scene);
  const std::vector<Piece> section = section_of(job, s);
  io::write_text(path("section.csv"), section_csv(section));
  for (std::size_t v = 0; v < s.images.size(); ++v)
    io::write_image(path(fmt::format("view{}.vti", v + 1)), view_image(job, s.images[v], v, made));
  if (job.picture) {
    io::Plot plot;
    const bool with_bumps = std::ranges::any_of(s.modes, &MeshMode::is_bump);
    for (std::size_t v = 0; v < s.images.size(); ++v) {
      const RefinedImage& view = s.images[v];
      const PlacedImage& measured = job.images[v].image;
      plot.panels.push_back(
          picture(fmt::format("image {}, tilted by {:.2f}°", v + 1, view.tilt_deg), measured,
                  measured.values, io::PlotColors::grey, "signal"));
      plot.panels.push_back(picture("simulated of the result", measured, view.simulated,
                                    io::PlotColors::grey, "signal"));
      plot.panels.back().image->range = plot.panels[plot.panels.size() - 2].image->range;
      plot.panels.push_back(picture("what is left", measured, view.residual,
                                    io::PlotColors::difference, "deviations"));
      if (with_bumps)
        plot.panels.push_back(picture("what it tells", measured, view.sensitivity_per_nm,
                                      io::PlotColors::heights, "1 / error (1/nm)"));
    }
    plot.panels.push_back(section_panel(job, s, section));
    plot.columns = with_bumps ? 4 : 3;
    plot.panels.back().columns = plot.columns;
    plot.width_px = 2400;
    plot.metadata = made;
    io::write_plot(path("panel.png"), plot);
  }
  io::write_text(path("report.json"), report(job, s).dump(2) + "\n");
  return written;
}

}  // namespace surf::workflow
