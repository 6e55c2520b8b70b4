// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/units.h"

int main() { return surf::format_length(3).empty() ? 1 : 0; }
