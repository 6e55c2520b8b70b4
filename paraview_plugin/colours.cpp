// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkSMSettings.h>

// How arrays look that nobody has coloured yet: ParaView asks its settings for a colour map by an
// array's name. The priority is below that of the user's own settings.
namespace {

constexpr const char* colours = R"json({"standard_presets": {
  "z_nm": "Viridis (matplotlib)",
  "height": "Viridis (matplotlib)",
  "start_nm": "Viridis (matplotlib)",
  "SE": "Grayscale",
  "BSE": "Grayscale",
  "SE1": "Grayscale",
  "SE2": "Grayscale",
  "signal": "Grayscale",
  "sem": "Grayscale",
  "simulated": "Grayscale",
  "calibrated": "Grayscale",
  "fitted": "Grayscale",
  "blend": "Grayscale",
  "certain": "Grayscale",
  "deviation_nm": "Inferno (matplotlib)",
  "radius_px": "Inferno (matplotlib)",
  "energy_ev": "Inferno (matplotlib)"
}})json";

// Done as the plugin is loaded.
[[maybe_unused]] const bool added =
    vtkSMSettings::GetInstance()->AddCollectionFromString(colours, 0);

}  // namespace
