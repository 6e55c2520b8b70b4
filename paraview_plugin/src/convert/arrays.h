// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkAOSDataArrayTemplate.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>

#include <string>
#include <utility>
#include <vector>

namespace surf::pv {

/// An array of VTK's, of class `Array`, over the memory of a vector that it has taken over: nothing
/// is copied. `Owner` is what the memory belongs to, `values` and `count` what of it the array
/// shows.
template <class Array, class Owner>
class TakenArray : public Array {
 public:
  template <class Value>
  static vtkSmartPointer<Array> make(Owner owner, Value* (*values)(Owner&), vtkIdType count,
                                     int components) {
    auto array = vtkSmartPointer<TakenArray>::Take(new TakenArray(std::move(owner)));
    array->InitializeObjectBase();
    array->SetNumberOfComponents(components);
    array->SetArray(values(array->owner_), count, 1);  // 1: the memory is not VTK's to free
    return array;
  }

 private:
  explicit TakenArray(Owner owner) : owner_(std::move(owner)) {}
  Owner owner_;
};

/// A vector of numbers as an array of that name.
template <class Array, class Value>
vtkSmartPointer<Array> take_array(std::vector<Value> values, const std::string& name,
                                  int components = 1) {
  const auto count = static_cast<vtkIdType>(values.size());
  auto array = TakenArray<Array, std::vector<Value>>::template make<Value>(
      std::move(values), [](std::vector<Value>& v) { return v.data(); }, count, components);
  array->SetName(name.c_str());
  return array;
}

/// Says the unit, which ParaView's information panel and files keep.
void set_unit(vtkDataArray* array, const char* unit);

/// The values of an array with one component as doubles, converted if they are something else.
std::vector<double> values_of(vtkDataArray* array);
/// The same into memory that is there already, as many as the array has.
void copy_values(vtkDataArray* array, std::vector<double>& values);

}  // namespace surf::pv
