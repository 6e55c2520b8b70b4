// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::pv {

// What properties may be. Each throws UsageError by the property's label: ranges in the XML bind
// the panel alone, scripts and state files set what they like.

/// Neither NaN nor infinite.
void need_number(double value, const char* label);
/// A number from `low` to `high`.
void need_between(double value, double low, double high, const char* label);
/// A number, at most 1e9 from 0: a place in nm, a grey level.
void need_moderate(double value, const char* label);
/// A number, 0 to 1e9, nm: squares of more than a metre would no longer be told from others.
void need_length(double nm, const char* label);
/// The same, above 0.
void need_positive(double nm, const char* label);
void need_within(int value, int low, int high, const char* label);

}  // namespace surf::pv
