// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "surf/workflow/profile_job.h"

class vtkTable;

namespace surf::pv {

/// "quantity", "value" and "standard_error" of all that a profile job measured, as profile.json has
/// it; NaN where no error is stated.
void fill_numbers(vtkTable* table, const workflow::ProfileJob& job,
                  const workflow::ProfileSummary& summary);

/// A row for each row of the image, or direction about a hole: the edges' places, their errors, and
/// the places by the threshold method, as edges.csv.
void fill_rows(vtkTable* table, const workflow::ProfileSummary& summary);

/// Mean profiles, measured and fitted, as profiles.csv: columns for each wall of each image, NaN in
/// the rows of other walls, so that a chart shows a line for each.
void fill_profiles(vtkTable* table, const workflow::ProfileJob& job,
                   const workflow::ProfileSummary& summary);

/// Spectra of edges and widths, as spectrum.csv; nothing where edges are too short for one.
void fill_roughness(vtkTable* table, const workflow::ProfileSummary& summary);

/// The edges as lines at the walls' upper end, where the rows show them.
vtkSmartPointer<vtkPolyData> edge_lines(const workflow::ProfileSummary& summary);

}  // namespace surf::pv
