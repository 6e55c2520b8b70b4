// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "scan.h"
#include "surf/core/height_field.h"
#include "surf/core/image.h"

namespace surf::io {

// One reader per format, called by read_height_field. `file` is the name for messages. `content` is
// the whole file and must outlive the scan. `is_...` looks at the content alone. The sizes in a
// reader's result fit the file. Failures are FileErrors.

bool is_gsf(std::string_view content);
Scan parse_gsf(const std::string& file, std::string_view content);

/// Gwyddion's own format.
bool is_gwy(std::string_view content);
Scan parse_gwy(const std::string& file, std::string_view content);

bool is_nanoscope(std::string_view content);
Scan parse_nanoscope(const std::string& file, std::string_view content);

/// Asylum Research.
bool is_ibw(std::string_view content);
Scan parse_ibw(const std::string& file, std::string_view content);

/// Nanosurf.
bool is_nid(std::string_view content);
Scan parse_nid(const std::string& file, std::string_view content);

bool is_park_tiff(std::string_view content);
Scan parse_park(const std::string& file, std::string_view content);

bool is_jpk(std::string_view content);
Scan parse_jpk(const std::string& file, std::string_view content);

/// Nanonis.
bool is_sxm(std::string_view content);
Scan parse_sxm(const std::string& file, std::string_view content);

bool is_wsxm(std::string_view content);
Scan parse_wsxm(const std::string& file, std::string_view content);

/// A matrix or XYZ points.
Scan parse_text_scan(const std::string& file, std::string_view content);

/// EXR, TIFF, PNG and VTI: semsurf's own and plain ones.
Scan parse_image_scan(const std::filesystem::path& path);

/// A field's placement and metadata, without its heights.
Image head_of(const HeightField& field, const std::map<std::string, std::string>& metadata);

/// How semsurf describes a field in its files: "KEY" to "VALUE" (image_formats.h).
std::string description_of(const HeightField& field,
                           const std::map<std::string, std::string>& metadata);
/// Applies placement and metadata from such lines. Returns whether there were any. Other lines are
/// ignored.
bool apply_description(std::string_view lines, const std::string& file, Scan& scan);

std::string format_gsf(const HeightField& field,
                       const std::map<std::string, std::string>& metadata);
std::string format_text_field(const HeightField& field,
                              const std::map<std::string, std::string>& metadata);

}  // namespace surf::io
