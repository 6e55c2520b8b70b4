// SPDX-License-Identifier: GPL-3.0-or-later
#include "digest.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include <cstring>
#include <string_view>

namespace surf::pv {
namespace {

/// FNV-1a, by words of eight bytes where there are some.
class Digest {
 public:
  std::uint64_t value = 14695981039346656037ull;

  void add(const void* bytes, std::size_t count) {
    const auto* at = static_cast<const unsigned char*>(bytes);
    for (; count >= 8; at += 8, count -= 8) {
      std::uint64_t word;
      std::memcpy(&word, at, 8);
      mix(word);
    }
    for (; count > 0; ++at, --count) mix(*at);
  }
  void add(double number) { add(&number, sizeof number); }
  void add(const char* text) {
    const std::string_view view = text ? text : "";
    mix(view.size());
    add(view.data(), view.size());
  }

  void add(vtkDataArray* array) {
    if (!array) return mix(0);
    mix(static_cast<std::uint64_t>(array->GetNumberOfValues()));
    if (array->HasStandardMemoryLayout())
      return add(array->GetVoidPointer(0), static_cast<std::size_t>(array->GetNumberOfValues()) *
                                               static_cast<std::size_t>(array->GetDataTypeSize()));
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
      for (int c = 0; c < array->GetNumberOfComponents(); ++c) add(array->GetComponent(i, c));
  }

  void add(vtkFieldData* fields) {
    for (int i = 0; fields && i < fields->GetNumberOfArrays(); ++i) {
      add(fields->GetArrayName(i));
      if (auto* const numbers = fields->GetArray(i)) add(numbers);
      auto* const texts = vtkStringArray::SafeDownCast(fields->GetAbstractArray(i));
      for (vtkIdType k = 0; texts && k < texts->GetNumberOfValues(); ++k)
        add(texts->GetValue(k).c_str());
    }
  }

  void add(vtkCellArray* cells) {
    if (!cells) return mix(0);
    add(cells->GetOffsetsArray());
    add(cells->GetConnectivityArray());
  }

  void add(vtkDataObject* data) {
    if (!data) return mix(0);
    add(data->GetClassName());
    add(data->GetFieldData());
    if (auto* const blocks = vtkCompositeDataSet::SafeDownCast(data)) {
      auto at = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
      for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem()) {
        mix(at->GetCurrentFlatIndex());
        if (at->HasCurrentMetaData())
          add(at->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME()));
        add(at->GetCurrentDataObject());
      }
    }
    if (auto* const set = vtkDataSet::SafeDownCast(data)) {
      add(static_cast<vtkFieldData*>(set->GetPointData()));
      add(static_cast<vtkFieldData*>(set->GetCellData()));
    }
    if (auto* const surface = vtkPolyData::SafeDownCast(data)) {
      if (surface->GetPoints()) add(surface->GetPoints()->GetData());
      add(surface->GetPolys());
      add(surface->GetStrips());
    }
    if (auto* const image = vtkImageData::SafeDownCast(data)) {
      add(image->GetExtent(), sizeof(int[6]));
      add(image->GetSpacing(), sizeof(double[3]));
      add(image->GetOrigin(), sizeof(double[3]));
    }
  }

 private:
  void mix(std::uint64_t word) { value = (value ^ word) * 1099511628211ull; }
};

}  // namespace

std::uint64_t digest(vtkDataObject* data) {
  Digest d;
  d.add(data);
  return d.value;
}

}  // namespace surf::pv
