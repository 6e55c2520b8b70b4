// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "surf/core/progress.h"

class vtkAlgorithm;
class vtkInformationVector;

namespace surf::pv {

/// Does what RequestData is to do and returns what that returns. Errors become ParaView's,
/// "subject: reason. remedy"; what was interrupted counts as done, its outputs are empty.
int attempt(vtkAlgorithm* self, const std::function<void()>& request);

/// The same for RequestInformation of images. If it fails their extent is empty: ParaView has put
/// the input's there, and what was asked for of that would be asked for again when the error is put
/// right.
int attempt_information(vtkAlgorithm* self, vtkInformationVector* outputs,
                        const std::function<void()>& request);

/// Long work of the libraries, on a thread of its own. The calling one, which must be ParaView's,
/// tells of the progress and asks every 50 ms whether to abort; then the work's token is cancelled.
/// Returns when the work has ended, throws what it throws, and Interrupted where it ended for the
/// token without saying so. How long the work took is left in the algorithm's information under
/// LIBRARY_SECONDS of vtkSemsurf, for bench/bench_paraview.py.
void work(vtkAlgorithm* self, const std::function<void(const Watch& watch)>& job);

/// A line in ParaView's messages that is no error: what had to be assumed, what may be wrong.
void warn(vtkAlgorithm* self, const std::string& text);

}  // namespace surf::pv
