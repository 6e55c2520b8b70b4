// SPDX-License-Identifier: GPL-3.0-or-later
// SEM images and materials as arguments of registration, reconstruction and profiles.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "data.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/register_job.h"

namespace surf::python {

inline constexpr const char* sem_type = "PathLike | Image | ArrayLike";

/// A microscope's file, or one channel of an image in memory, whose channel 'valid' is its mask.
workflow::SemInput sem_of(const Call& call, py::handle value, const std::string& argument);

/// One, or a list of them.
std::vector<workflow::SemInput> sems_of(const Call& call, const std::string& argument);

/// The material that keywords choose; its name is empty where they choose none.
mc::Material material_of(const Call& call);

/// Files describe what they were made from by its files. Throws UsageError for data in memory.
void require_file(const std::filesystem::path& file, const std::string& argument);

py::dict found_of(const Registration& registration);
py::array matrix_of(const Affine& map);

/// An image of one channel.
py::object picture_of(const PlacedImage& image, const std::string& name);
py::object picture_of(Grid<double> values, const Placement& placement, const std::string& name);

}  // namespace surf::python
