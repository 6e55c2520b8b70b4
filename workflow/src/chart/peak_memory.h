// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::workflow {

/// The rise of the process's resident memory above its value at construction. Linux records the
/// peak; elsewhere, or if the system does not allow resetting it, the rise is unknown.
class PeakMemory {
 public:
  PeakMemory();
  double bytes() const;  ///< 0 if unknown

 private:
  double before_ = 0;
  bool known_ = false;
};

}  // namespace surf::workflow
