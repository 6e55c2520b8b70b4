// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::io {

// Names in `extras`, where semsurf writes data besides the geometry of a glTF file. Keys of
// asset.extras:
inline constexpr const char* gltf_own_key = "semsurf";  // an object with the following keys
// "nm": unit of the vertices before the root node.
inline constexpr const char* gltf_unit_key = "unit";
inline constexpr const char* gltf_magnification_key = "magnification";
inline constexpr const char* gltf_exaggeration_key = "z_exaggeration";
inline constexpr const char* gltf_metadata_key = "metadata";

// Keys of meshes[].extras:
inline constexpr const char* gltf_scalars_key = "scalars";  // a list of {attribute, name, unit}
inline constexpr const char* gltf_drape_key = "drape";      // {name, pitch_x_nm, origin_x_nm, ...}
inline constexpr const char* gltf_tracks_key = "tracks";    // lists with an entry for each track

inline constexpr const char* gltf_energy_attribute = "_ENERGY_EV";
inline constexpr const char* gltf_material_attribute = "_MATERIAL";

}  // namespace surf::io
