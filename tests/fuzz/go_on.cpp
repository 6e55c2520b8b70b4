// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "accepted.h"
#include "afm/scan_formats.h"
#include "memory_files.h"
#include "surf/afm/background.h"
#include "surf/afm/clean.h"
#include "surf/afm/morphology.h"
#include "surf/afm/row_level.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/io/height_field_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/measure_mesh.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/smooth_mesh.h"
#include "surf/sem/slope_model.h"
#include "surfaces/known_formats.h"

namespace surf::test {
namespace {

constexpr std::size_t most_triangles = 300, most_samples = 1024;

template <class Data>
void expect_valid_data(const Data& data, const char* what) {
  try {
    validate(data);
  } catch (const Error& error) {
    throw std::logic_error(std::string(what) + " returned invalid data: " + error.what());
  }
}

/// Runs a step, which may refuse its input: the steps behind it go on with the input as it was.
template <class Step>
void try_step(Step step) {
  try {
    step();
  } catch (const Error&) {
  }
}

// ---- meshes

void edit(const TriangleMesh& mesh) {
  check_mesh(mesh);
  try_step([&] { measure_mesh(mesh); });
  try_step([&] {
    RepairOptions options;
    options.threads = 1;
    const TriangleMesh repaired = repair_mesh(mesh, options).mesh;
    expect_valid_data(repaired, "repair_mesh");
    SimplifyOptions simplify;
    simplify.triangles = repaired.triangles.size() / 2;
    simplify.threads = 1;
    expect_valid_data(simplify_mesh(repaired, simplify).mesh, "simplify_mesh");
    expect_valid_data(smooth_mesh(repaired), "smooth_mesh");
  });
}

/// Writes the scene in a format and reads it again.
void through(const io::MeshFormat& format, const SurfaceScene& scene) {
  const std::filesystem::path path = "written/again" + std::string(format.forms.front().extension);
  std::vector<io::OutputFile> files;
  try {
    files = format.format(path, io::view_of(scene));
  } catch (const Error&) {
    return;  // not everything can be written in every format
  }
  for (io::OutputFile& file : files) put_memory_file(file.path, std::move(file.content));
  try {
    expect_valid_data(io::read_surfaces(path), "read_surfaces");
  } catch (const Error& error) {
    throw std::logic_error(std::string("a written file is not read again: ") + error.what());
  }
}

void go_on_with_surfaces(SurfaceScene scene) {
  for (Surface& surface : scene.surfaces) {
    if (surface.mesh.triangles.size() > most_triangles) return;
    surface.drape.reset();  // OpenImageIO would look for its picture on the disk
  }
  for (const Surface& surface : scene.surfaces) edit(merge_equal_vertices(surface.mesh));
  for (const io::MeshFormat* format : io::known_formats())
    if (!format->needs_vtk) through(*format, scene);
}

// ---- scans

const ImageModel& small_model(double pixel_nm) {
  static std::shared_ptr<const ImageModel> model;
  if (!model || model->scope().pixel_nm != pixel_nm) {
    SlopeModelParameters parameters;
    parameters.channels = {{"SE", 0.2, {}}};
    model = make_slope_model({pixel_nm, "Si", 1000, 0}, parameters);
  }
  return *model;
}

void expect_read_again(const char* path, std::string content) {
  put_memory_file(path, std::move(content));
  try {
    expect_valid_data(io::HeightFile(path).read().field, "HeightFile");
  } catch (const Error& error) {
    throw std::logic_error(std::string("a written scan is not read again: ") + error.what());
  }
}

void go_on_with_field(HeightField field) {
  if (field.z_nm.size() > most_samples) return;
  try_step([&] { subtract(field, fit_plane(field)); });
  try_step([&] { level_rows(field, RowMethod::median); });
  MedianOptions median;
  median.fill_holes = true;
  median.threads = 1;
  try_step([&] { field = median_filter(field, median).field; });
  expect_valid_data(field, "levelling and cleaning");
  try_step([&] {
    const Tip tip = parabolic_tip(10, {field.pitch_x_nm, field.pitch_y_nm, 5, 5});
    MorphologyOptions options;
    options.threads = 1;
    expect_valid_data(erode(field, tip, options), "erode");
  });
  try_step([&] { expect_valid_data(height_field_sheet(field), "height_field_sheet"); });
  try_step([&] { small_model(field.pitch_x_nm).predict(field); });
  // As write_height_field, which refuses heights that 32 bits cannot hold.
  if (std::ranges::all_of(field.z_nm.data(), [](double z) { return std::abs(z) < 1e38; }))
    try_step([&] { expect_read_again("written/again.gsf", io::format_gsf(field, {})); });
  try_step([&] { expect_read_again("written/again.txt", io::format_text_field(field, {})); });
}

// ---- models

void go_on_with_model(const TrainedModel& trained) {
  const auto model = make_model(trained);
  HeightField field;
  field.z_nm = Grid<double>(12, 10);
  field.pitch_x_nm = field.pitch_y_nm = trained.scope.pixel_nm > 0 ? trained.scope.pixel_nm : 1;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 12; ++x) field.z_nm(x, y) = (x * 7 + y * 5) % 11;
  try_step([&] {
    for (const Grid<double>& image : model->predict(field))
      for (const double value : image.data())
        if (value != value) throw std::logic_error("a model of finite numbers predicts NaN");
  });
}

}  // namespace

void expect_valid(const Accepted& accepted) {
  constexpr const char* reader = "a reader";
  if (accepted.surfaces) expect_valid_data(*accepted.surfaces, reader);
  for (const HeightField& field : accepted.fields) expect_valid_data(field, reader);
  if (accepted.image) expect_valid_data(*accepted.image, reader);
}

void go_on_with(const Accepted& accepted) {
  if (accepted.surfaces) go_on_with_surfaces(*accepted.surfaces);
  for (const HeightField& field : accepted.fields) go_on_with_field(field);
  if (accepted.model) go_on_with_model(*accepted.model);
}

}  // namespace surf::test
