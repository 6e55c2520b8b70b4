// SPDX-License-Identifier: GPL-3.0-or-later
// Grids and ndarrays. Row 0 of both is the lowest row, so that neither is ever flipped.
#pragma once

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf::python {

namespace py = pybind11;

/// An array of rows that shares the grid's memory; `owner` keeps that alive.
template <class T>
py::array view_of(const Grid<T>& grid, py::handle owner) {
  const py::ssize_t width = grid.width(), height = grid.height(), size = sizeof(T);
  return py::array(py::dtype::of<T>(), {height, width}, {width * size, size}, grid.data().data(),
                   owner);
}

/// An array that owns what the vector held.
template <class T>
py::array array_of(std::vector<T> values) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const auto size = static_cast<py::ssize_t>(kept->size());
  const T* const data = kept->data();
  const py::capsule owner(kept.release(),
                          [](void* held) { delete static_cast<std::vector<T>*>(held); });
  return py::array(py::dtype::of<T>(), {size}, {static_cast<py::ssize_t>(sizeof(T))}, data, owner);
}

/// An array of rows that owns what the grid held.
template <class T>
py::array array_of(Grid<T> grid) {
  const int width = grid.width(), height = grid.height();
  return array_of(std::move(grid.data())).reshape({height, width});
}

/// Values that are not 0 count; the array holds True and False.
py::array array_of(const Mask& mask);

/// The grid of a two-dimensional array, copied once. Throws InvalidInput naming `subject`.
template <class T>
Grid<T> grid_of(py::handle values, const std::string& subject) {
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
  const Array array = Array::ensure(values);
  if (!array) {
    PyErr_Clear();
    throw InvalidInput(subject, "it is no array of numbers", "Give an array of two dimensions");
  }
  if (array.ndim() == 2 && array.size() == 0)
    throw InvalidInput(subject, "the array is empty", "Give an array with rows and columns");
  if (array.ndim() != 2)
    throw InvalidInput(subject, fmt::format("the array has {} dimensions", array.ndim()),
                       "Give an array of two dimensions, rows from the lowest to the highest");
  Grid<T> grid(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  std::copy(array.data(), array.data() + array.size(), grid.data().begin());
  return grid;
}

/// A mask of an array that is not 0 where samples count. Throws InvalidInput for another size.
Mask mask_of(py::handle values, int width, int height, const std::string& subject);

}  // namespace surf::python
