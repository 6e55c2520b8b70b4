// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/io/surface_file.h"

namespace surf::io {

/// What a file of surfaces says about itself in text: in comments (OBJ, PLY, OFF), in a header
/// (STL), in field data (VTP). Files of other programs have none of it; their numbers are nm.
struct SurfaceNote {
  double unit_nm = 1;              ///< > 0: nm of the specimen that a 1 stands for
  double magnification = 1e6;      ///< in magnified formats, where unit_nm follows from it
  double z_exaggeration = 1;       ///< > 0: heights are this much larger still
  std::vector<std::string> names;  ///< of the surfaces, in the file's order
  std::map<std::string, std::string> scalar_units;  ///< by the scalar's name
  std::map<std::size_t, std::string> drapes;        ///< by the surface's place: the picture's file
  std::map<std::string, std::string> metadata;
  bool is_ours = false;      ///< semsurf wrote the file
  bool states_unit = false;  ///< unit_nm is what the file says, not assumed

  Vec3 to_file(const Vec3& nm) const {
    return {nm.x / unit_nm, nm.y / unit_nm, nm.z * z_exaggeration / unit_nm};
  }
  Vec3 to_nm(const Vec3& file) const {
    return {file.x * unit_nm, file.y * unit_nm, file.z * unit_nm / z_exaggeration};
  }
};

// Keys are "surface:KEY", for metadata "semsurf:KEY" as in images. Magnified formats say
// "magnification" in place of "unit_nm": their readers take 1 for a millimetre.

/// The note's entries in the order in which files have them. `magnified` as in `SurfaceFormat`.
std::vector<std::pair<std::string, std::string>> to_entries(const SurfaceNote& note,
                                                            bool magnified);

/// Takes an entry over; others than ours are ignored. Throws FileError where a number is none.
void apply_entry(std::string_view key, std::string_view value, const std::string& file,
                 SurfaceNote& note);

/// "KEY=VALUE" on one line: control characters, '%' and '\' become codes of three characters, as
/// %0A.
std::string to_line(std::string_view key, std::string_view value);
/// Undoes it and takes the entry over; other lines are ignored.
void apply_line(std::string_view line, const std::string& file, SurfaceNote& note);

/// The comments at the beginning of a text file: lines that begin with `mark`, also behind one
/// other line.
void apply_comments(std::string_view content, char mark, const std::string& file,
                    SurfaceNote& note);

/// A name on one line as other programs show it: blanks and special characters become '_'.
std::string plain_name(std::string_view name);

/// The 80 bytes in front of a binary STL file: magnification, exaggeration and what fits of the
/// metadata.
std::string to_stl_header(const SurfaceNote& note);
void apply_stl_header(std::string_view header, const std::string& file, SurfaceNote& note);

/// Magnification and unit of a format whose readers take 1 for a millimetre, from each other.
inline constexpr double mm_nm = 1e6;
inline void set_magnification(SurfaceNote& note, double magnification) {
  note.magnification = magnification;
  note.unit_nm = mm_nm / magnification;
}
inline void set_magnification(SurfaceNote& note, const Magnification& magnification) {
  set_magnification(note, magnification.factor);
  note.z_exaggeration = magnification.z_exaggeration;
}

}  // namespace surf::io
