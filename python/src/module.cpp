// SPDX-License-Identifier: GPL-3.0-or-later
// The extension module behind `import semsurf` (semsurf/__init__.py).
#include "surf/core/module.h"
#include "data.h"
#include "errors.h"
#include "surf/workflow/version.h"

PYBIND11_MODULE(_semsurf, module) {
  using namespace surf::python;
  // What is defined here is semsurf's, wherever it is: for help, errors and type checkers.
  const py::object own_name = module.attr("__name__");
  module.attr("__name__") = "semsurf";
  translate_errors();
  add_heights(module);
  add_mesh(module);
  add_image(module);
  add_tip(module);
  add_files(module);
  add_simulate(module);
  add_scans(module);
  add_tips(module);
  add_noise(module);
  add_meshes(module);
  add_models(module);
  add_chain(module);
  add_profile(module);
  add_materials(module);
  add_survey(module);
  add_samples(module);
  add_libraries(module);
  add_calibrate(module);
  add_sweep(module);
  add_chart(module);
  add_view(module);
  add_compare(module);
  add_refine(module);
  add_surfaces(module);
  module.attr("__version__") = surf::workflow::version();
  module.def("described_functions", &described_functions);
  module.def("set_module_folder", &surf::set_module_folder);
  module.attr("__name__") = own_name;
}
