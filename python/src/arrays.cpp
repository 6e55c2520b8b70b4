// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"

#include <algorithm>

namespace surf::python {

py::array array_of(const Mask& mask) {
  py::array_t<bool> array({mask.height(), mask.width()});
  std::ranges::transform(mask.data(), array.mutable_data(),
                         [](unsigned char counts) { return counts != 0; });
  return array;
}

Mask mask_of(py::handle values, int width, int height, const std::string& subject) {
  const Grid<double> numbers = grid_of<double>(values, subject);
  if (numbers.width() != width || numbers.height() != height)
    throw InvalidInput(subject,
                       fmt::format("it has {} x {} samples, the other array {} x {}",
                                   numbers.width(), numbers.height(), width, height),
                       "Give a mask of the same size");
  Mask mask(width, height);
  std::ranges::transform(numbers.data(), mask.data().begin(),
                         [](double number) { return static_cast<unsigned char>(number != 0); });
  return mask;
}

}  // namespace surf::python
