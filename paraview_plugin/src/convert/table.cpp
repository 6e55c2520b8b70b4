// SPDX-License-Identifier: GPL-3.0-or-later
#include "convert/table.h"

#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include "convert/arrays.h"

namespace surf::pv {

void add_column(vtkTable* table, const std::string& name, std::vector<double> values) {
  table->AddColumn(take_array<vtkDoubleArray>(std::move(values), name));
}

void add_column(vtkTable* table, const std::string& name, std::vector<int> values) {
  table->AddColumn(take_array<vtkIntArray>(std::move(values), name));
}

void add_column(vtkTable* table, const std::string& name, const std::vector<std::string>& values) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  for (const std::string& value : values) array->InsertNextValue(value);
  table->AddColumn(array);
}

void add_quantities(vtkTable* table, const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const Quantity& q : quantities) {
    names.push_back(q.name);
    values.push_back(q.value);
  }
  add_column(table, "quantity", names);
  add_column(table, "value", std::move(values));
}

}  // namespace surf::pv
