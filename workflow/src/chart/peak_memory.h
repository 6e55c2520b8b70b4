// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::workflow {

/// How far the process's resident memory rises above where it is when this is made. Linux keeps the
/// peak; elsewhere, or where the system does not let it be reset, nothing is known.
class PeakMemory {
 public:
  PeakMemory();
  double bytes() const;  ///< 0 where it is not known

 private:
  double before_ = 0;
  bool known_ = false;
};

}  // namespace surf::workflow
