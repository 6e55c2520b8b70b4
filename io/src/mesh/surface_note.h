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

/// The text that a file of surfaces holds about itself: in comments (OBJ, PLY, OFF), in a header
/// (STL), in field data (VTP). Files of other programs have none; their numbers are nm.
struct SurfaceNote {
  double unit_nm = 1;              ///< > 0: nm of the specimen per file unit
  double magnification = 1e6;      ///< in magnified formats, which derive unit_nm from it
  double z_exaggeration = 1;       ///< > 0: additional factor of the heights
  std::vector<std::string> names;  ///< names of the surfaces, in the file's order
  std::map<std::string, std::string> scalar_units;  ///< unit by name of the scalar
  std::map<std::size_t, std::string> drapes;        ///< picture file by number of the surface
  std::map<std::string, std::string> metadata;
  bool is_ours = false;      ///< semsurf wrote the file
  bool states_unit = false;  ///< the file states unit_nm; false: it is assumed

  Vec3 to_file(const Vec3& nm) const {
    return {nm.x / unit_nm, nm.y / unit_nm, nm.z * z_exaggeration / unit_nm};
  }
  Vec3 to_nm(const Vec3& file) const {
    return {file.x * unit_nm, file.y * unit_nm, file.z * unit_nm / z_exaggeration};
  }
};

// Keys are "surface:KEY", and for metadata "semsurf:KEY" as in images. Magnified formats state
// "magnification" instead of "unit_nm": their readers take 1 for a millimetre.

/// The note's entries, in the order in which files hold them. `magnified` as in `SurfaceFormat`.
std::vector<std::pair<std::string, std::string>> to_entries(const SurfaceNote& note,
                                                            bool magnified);

/// Stores an entry in the note; entries of other programs are ignored. Throws FileError if a number
/// is malformed.
void apply_entry(std::string_view key, std::string_view value, const std::string& file,
                 SurfaceNote& note);

/// "KEY=VALUE" on one line: control characters, '%' and '\' become codes of three characters, as
/// %0A.
std::string to_line(std::string_view key, std::string_view value);
/// Decodes a line of `to_line` and stores the entry; other lines are ignored.
void apply_line(std::string_view line, const std::string& file, SurfaceNote& note);

/// Applies the comments at the beginning of a text file: lines that begin with `mark`, also after
/// one other line.
void apply_comments(std::string_view content, char mark, const std::string& file,
                    SurfaceNote& note);

/// Formats a name on one line for other programs: blanks and special characters become '_'.
std::string plain_name(std::string_view name);

/// The 80-byte header of a binary STL file: magnification, exaggeration, and as much of the
/// metadata as fits.
std::string to_stl_header(const SurfaceNote& note);
void apply_stl_header(std::string_view header, const std::string& file, SurfaceNote& note);

/// Set the magnification and the unit that follows from it, for formats whose readers take 1 for a
/// millimetre.
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
