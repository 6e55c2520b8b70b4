// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "surf/core/error.h"
#include "surf/io/scan_parameters.h"

namespace surf::python {
namespace {

PlacedImage placed(const Picture& picture, const io::SemReadOptions& reading,
                   const std::string& argument) {
  const Image& image = picture.image;
  const std::string name = reading.channel.empty() ? image.channels.front().name : reading.channel;
  const Channel* const channel = image.find(name);
  if (!channel)
    throw UsageError(argument, fmt::format("the image has no channel '{}'", name),
                     "Choose one by `scan.sem_channel`");
  PlacedImage out;
  out.placement() = image.placement();
  if (reading.pixel_x_nm) out.pitch_x_nm = *reading.pixel_x_nm;
  if (reading.pixel_y_nm) out.pitch_y_nm = *reading.pixel_y_nm;
  out.values = Grid<double>(image.width(), image.height());
  std::ranges::copy(channel->values.data(), out.values.data().begin());
  out.valid = Mask(image.width(), image.height(), 1);
  const Channel* const valid = image.find("valid");
  for (std::size_t i = 0; i < out.valid.size(); ++i)
    if (!std::isfinite(out.values.data()[i]) || (valid && valid->values.data()[i] == 0))
      out.valid.data()[i] = 0;
  if (std::ranges::count(out.valid.data(), 0) == 0) out.valid = {};
  return out;
}

}  // namespace

workflow::SemInput sem_of(const Call& call, py::handle value, const std::string& argument) {
  workflow::SemInput sem;
  call.apply(sem.reading);
  if (is_path(value)) {
    sem.file = path_of(value);
    io::SemFile file;
    {
      const py::gil_scoped_release unlocked;
      file = io::read_sem_image(sem.file, sem.reading);
    }
    Call::notes(file.notes, sem.file.string());
    sem.image = std::move(file.image);
    return sem;
  }
  const bool is_array = !py::isinstance<Picture>(value);
  if (is_array && !sem.reading.pixel_x_nm)
    throw UsageError("`scan.pixel_size`", "an array does not say how large its pixels are",
                     "Add `scan.pixel_size=2nm`, or give a semsurf.Image");
  sem.image = placed(picture_of(value, argument), sem.reading, argument);
  validate(sem.image, argument.c_str());
  return sem;
}

std::vector<workflow::SemInput> sems_of(const Call& call, const std::string& argument) {
  const py::object given = call[argument];
  std::vector<workflow::SemInput> all;
  if (given.is_none()) return all;
  if (!PyList_Check(given.ptr()) && !PyTuple_Check(given.ptr()))
    return {sem_of(call, given, argument)};
  for (const py::handle one : given) all.push_back(sem_of(call, one, argument));
  return all;
}

mc::Material material_of(const Call& call) {
  const auto choice = call.told<io::MaterialChoice>();
  if (choice.name.empty()) return {};
  std::vector<std::string> notes;
  mc::Material material = io::find_material(choice, notes);
  Call::notes(notes);
  return material;
}

void require_file(const std::filesystem::path& file, const std::string& argument) {
  if (file.empty())
    throw UsageError(argument, "it is in memory, and the files to write name the file it is from",
                     "Write it to a file first, or leave out `output`");
}

py::array matrix_of(const Affine& m) {
  const std::vector<double> numbers{m.xx, m.xy, m.x0, m.yx, m.yy, m.y0};
  return array_of(numbers).reshape({2, 3});
}

py::dict found_of(const Registration& r) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < 6; ++i)
    errors.push_back(std::sqrt(std::max(r.covariance[7 * i], 0.0)));
  py::dict d;
  d["transform_stderr"] = array_of(std::move(errors)).reshape({2, 3});
  d["verdict"] = workflow::name(r.verdict);
  d["reason"] = with_keywords(r.reason);
  d["score"] = r.score;
  d["stderr_px"] = r.stderr_px;
  d["overlap"] = r.overlap;
  py::list rivals;
  for (const RegistrationRival& rival : r.rivals) {
    py::dict one;
    one["transform"] = matrix_of(rival.sem_to_afm);
    one["score"] = rival.score;
    one["distance_px"] = rival.distance_px;
    rivals.append(findings(one));
  }
  d["rivals"] = rivals;
  return d;
}

py::object picture_of(Grid<double> values, const Placement& placement, const std::string& name) {
  Picture picture;
  picture.image.placement() = placement;
  Grid<float> narrow(values.width(), values.height());
  std::ranges::transform(values.data(), narrow.data().begin(),
                         [](double value) { return static_cast<float>(value); });
  picture.image.channels = {{name, "1", std::move(narrow)}};
  return object_of(std::move(picture));
}

py::object picture_of(const PlacedImage& image, const std::string& name) {
  return picture_of(image.values, image.placement(), name);
}

}  // namespace surf::python
