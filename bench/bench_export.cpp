// SPDX-License-Identifier: GPL-3.0-or-later
// How few triangles hold a scan within a tolerance, beside other ways; and how fast surfaces of ten
// million triangles are written and read, beside the plain writing of as many bytes to the same
// folder.
//   bench_export [--quick] [FOLDER]
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/afm/noise.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/mesh/vertex_curvature.h"

namespace {

using namespace surf;

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Smooth hills, of curvature about 1/400 per nm.
HeightField hills(int width) {
  HeightField f{{}, Grid<double>(width, width)};
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x)
      f.z_nm(x, y) =
          4 * std::sin(0.021 * x + 0.3) * std::cos(0.017 * y) + 3 * std::sin(0.011 * (x + 2 * y));
  return f;
}

/// Every so many-th sample, as triangles; the largest vertical distance from the field in between.
double coarse_deviation_nm(const HeightField& f, int step) {
  double worst = 0;
  for (int y = 0; y + step < f.z_nm.height(); y += step)
    for (int x = 0; x + step < f.z_nm.width(); x += step)
      for (int j = 0; j <= step; ++j)
        for (int i = 0; i <= step; ++i) {
          const double u = double(i) / step, v = double(j) / step;
          const double low = f.z_nm(x, y), high = f.z_nm(x + step, y + step);
          const double side = u > v ? f.z_nm(x + step, y) : f.z_nm(x, y + step);
          const double z = u > v ? low + u * (side - low) + v * (high - side)
                                 : low + v * (side - low) + u * (high - side);
          worst = std::max(worst, std::abs(z - f.z_nm(x + i, y + j)));
        }
  return worst;
}

void compare_sizes(const char* name, const HeightField& f, double tolerance_nm,
                   bool with_quadrics) {
  ThinSummary s;
  const double took = seconds([&] { s = thin_height_field(f, {tolerance_nm}).summary; });
  fmt::print("{:<28}{:>9.3g} nm{:>11}{:>11} {:>6.2f} s", name, tolerance_nm, s.triangles_before,
             s.triangles_after, took);
  int step = 1;
  while (coarse_deviation_nm(f, step + 1) <= tolerance_nm) ++step;
  fmt::print("{:>11}", s.triangles_before / static_cast<std::size_t>(step * step));
  if (with_quadrics) {
    SimplifySummary q;
    SimplifyOptions options;
    options.tolerance_nm = tolerance_nm;
    const TriangleMesh sheet = height_field_sheet(f);
    const double quadrics = seconds([&] { q = simplify_mesh(sheet, options).summary; });
    fmt::print("{:>11} {:>6.1f} s", q.triangles_after, quadrics);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

double peak_mb() {
  rusage use;
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_maxrss) / 1e3;
}

/// In a process of its own, so that its memory is its own too: what it writes comes back.
void apart(const std::function<void()>& work) {
  std::fflush(stdout);
  if (const pid_t child = fork(); child == 0) {
    work();
    std::fflush(stdout);
    _exit(0);
  } else {
    waitpid(child, nullptr, 0);
  }
}

double plain_writing(const std::filesystem::path& path, std::uintmax_t bytes) {
  const std::vector<char> block(std::size_t{1} << 20, 'x');
  const double took = seconds([&] {
    std::ofstream out(path, std::ios::binary);
    for (std::uintmax_t done = 0; done < bytes; done += block.size())
      out.write(block.data(), std::streamsize(block.size()));
  });
  std::filesystem::remove(path);
  return took;
}

void write_and_read(const SurfaceScene& scene, const std::string& extension,
                    const std::filesystem::path& folder) {
  apart([&] {
    const double before = peak_mb();
    const std::filesystem::path path = folder / ("bench_export" + extension);
    const double write = seconds([&] { io::write_surfaces(path, scene); });
    const double grown = peak_mb() - before;
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().filename().string().starts_with("bench_export")) bytes += entry.file_size();
    const double floor = plain_writing(folder / "plain", bytes);
    const double read = seconds([&] { io::read_surfaces(path); });
    const double mb = static_cast<double>(bytes) / 1e6;
    fmt::print("{:<8}{:>8.0f}{:>9.1f}{:>9.0f}{:>10.0f}{:>8.1f}{:>10.0f}{:>9.1f}\n", extension, mb,
               write, mb / write, mb / floor, write / floor, grown, read);
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().filename().string().starts_with("bench_export"))
        std::filesystem::remove(entry.path());
  });
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "bench_export";
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--quick")) quick = true;
    else folder = argv[i];
  }
  std::filesystem::create_directories(folder);
  const int width = quick ? 256 : 1024;
  fmt::print(
      "Triangles that hold a field of {} x {} samples\n{:<28}{:>12}{:>11}{:>20}{:>11}{:>20}\n",
      width, width, "", "tolerance", "of all", "greedy Delaunay", "raster", "quadrics (sampled)");
  for (const double tolerance : {0.1, 1.0}) {
    compare_sizes("smooth hills", hills(width), tolerance, quick);
    HeightField noisy = hills(width);
    const Grid<double> noise = simulate_noise({0.8, 0.0025}, width, width, 1);
    for (std::size_t i = 0; i < noise.size(); ++i) noisy.z_nm.data()[i] += noise.data()[i];
    compare_sizes("the same, noise of 0.083 nm", noisy, tolerance, false);
    compare_sizes("rough, 4 nm rms over 30 nm", make_rough({1.0 * width, 1.0 * width, 1}, 4, 30, 1),
                  tolerance, false);
  }

  const int side = quick ? 708 : 2237;
  SurfaceScene scene;
  scene.surfaces.push_back(
      {"surface", height_field_sheet(make_rough({1.0 * side, 1.0 * side, 1}, 4, 30, 1)), {}, {}});
  Surface& surface = scene.surfaces[0];
  VertexScalar height{"height", "nm", {}};
  for (const Vec3& v : surface.mesh.vertices_nm) height.values.push_back(static_cast<float>(v.z));
  const double curvature = seconds([&] {
    surface.scalars.push_back({"curvature", "1/nm", mean_curvature(surface.mesh)});
  });
  surface.scalars.push_back(std::move(height));
  fmt::print("\n{} triangles, two scalars where the format has them; curvature took {:.1f} s\n",
             surface.mesh.triangles.size(), curvature);
  fmt::print(
      "{:<8}{:>8}{:>9}{:>9}{:>10}{:>8}{:>10}{:>9}\n{:<8}{:>8}{:>9}{:>9}{:>10}{:>8}{:>10}{:>9}\n",
      "", "file", "written", "", "plainly", "", "memory", "read", "", "MB", "s", "MB/s", "MB/s",
      "ratio", "MB more", "s");
  for (const io::SurfaceFormat& format : io::surface_formats())
    write_and_read(scene, std::string(format.extension), folder);
  std::filesystem::remove_all(folder);
}
