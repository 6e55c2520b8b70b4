// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

class vtkTable;

namespace surf::pv {

/// Columns of one length; names carry their unit, as "threshold_nm".
void add_column(vtkTable* table, const std::string& name, std::vector<double> values);
void add_column(vtkTable* table, const std::string& name, std::vector<int> values);
void add_column(vtkTable* table, const std::string& name, const std::vector<std::string>& values);

/// Two columns, "quantity" and "value", for results that are one number each.
struct Quantity {
  std::string name;
  double value = 0;
};
void add_quantities(vtkTable* table, const std::vector<Quantity>& quantities);

}  // namespace surf::pv
