// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/arrays.h"

#include <vtkDataArrayRange.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>

#include <algorithm>

namespace surf::pv {

void set_unit(vtkDataArray* array, const char* unit) {
  array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), unit);
}

void copy_values(vtkDataArray* array, std::vector<double>& values) {
  if (auto* doubles = vtkDoubleArray::FastDownCast(array)) {
    std::copy_n(doubles->GetPointer(0), values.size(), values.begin());
  } else if (auto* floats = vtkFloatArray::FastDownCast(array)) {
    std::copy_n(floats->GetPointer(0), values.size(), values.begin());
  } else {
    const auto range = vtk::DataArrayValueRange<1>(array);
    std::copy(range.begin(), range.end(), values.begin());
  }
}

std::vector<double> values_of(vtkDataArray* array) {
  std::vector<double> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
  copy_values(array, values);
  return values;
}

}  // namespace surf::pv
