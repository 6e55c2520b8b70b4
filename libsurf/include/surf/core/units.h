// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace surf {

// Converts text with units to numbers in semsurf's native units: nm, eV, degrees. Everything that a
// person writes goes through these parsers (command line, scene files); libraries pass plain
// numbers. `subject` names the option or key in the error message.

/// "2", "2nm", "0.5um", "1e-3 mm", "3pm", "2A", "1m" to nm. Bare numbers are nm.
/// Throws UsageError on unknown suffixes, NaN, infinity and trailing text.
double parse_length_nm(std::string_view text, std::string_view subject);

/// Parses "2nm" (for both) or "2nmx3nm", each above 0. Throws like `parse_length_nm`.
std::pair<double, double> parse_two_lengths_nm(std::string_view text, std::string_view subject);

/// "500", "500eV", "1keV", "0.03MeV" to eV. Bare numbers are eV.
double parse_energy_ev(std::string_view text, std::string_view subject);

/// "30", "30deg", "0.5rad", "10mrad" to degrees. Bare numbers are degrees.
double parse_angle_deg(std::string_view text, std::string_view subject);

/// "100", "100pA", "0.1nA" to pA. Bare numbers are pA.
double parse_current_pa(std::string_view text, std::string_view subject);

/// "10", "10us", "500ns", "1ms" to us. Bare numbers are us.
double parse_time_us(std::string_view text, std::string_view subject);

/// Parses waiting times: "90", "90s", "5min", "2h", "1d", "500ms" to seconds. Bare numbers are
/// seconds.
double parse_duration_s(std::string_view text, std::string_view subject);

/// "1%" or "0.01" to 0.01; both give exactly the same number. Must be finite and >= 0.
double parse_share(std::string_view text, std::string_view subject);

/// 0.013 to "1.3 %", with the fewest digits from which `parse_share` restores the number.
std::string format_share(double share);

/// The length of one `unit` ("nm", "um", "mm", "m", "pm", "A", "in") in nm. Throws UsageError for
/// an unknown unit.
double unit_length_nm(std::string_view unit, std::string_view subject);

/// Formats a length for people, with `digits` significant digits: "398 nm", "1.20 um", "3.5 mm".
/// Extreme lengths are written as "1.00e+291 m".
std::string format_length(double length_nm, int digits = 3);

/// The shortest decimal text that reads back as exactly `value`.
std::string format_exact(double value);

/// Electrons in 1 pA for 1 us (CODATA 2018: e = 1.602176634e-19 C).
inline constexpr double electrons_per_pa_us = 1e-18 / 1.602176634e-19;

inline constexpr double degrees_to_radians = 0.017453292519943295;

}  // namespace surf
