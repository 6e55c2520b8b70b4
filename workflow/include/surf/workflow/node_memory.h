// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace surf::workflow {

/// Memory shared by the processes on one machine that do a job together. All of them call the same
/// functions in the same order.
class NodeMemory {
 public:
  virtual ~NodeMemory() = default;

  /// Whether this process is the first one, which fills the shared memory.
  virtual bool is_first() const = 0;
  /// Number of sharing processes, at least 2.
  virtual int processes() const = 0;
  /// Sends `bytes` from the first process to the others.
  virtual void tell(std::string& bytes) = 0;
  /// Allocates shared memory, aligned to 64 bytes, which lasts as long as the pointer is held.
  /// `bytes` is the same for all processes. The first process fills the memory, then all call
  /// `share`. From then on the memory is read-only.
  virtual std::shared_ptr<std::byte> allocate(std::size_t bytes) = 0;
  virtual void share(std::byte* memory, std::size_t bytes) = 0;
};

}  // namespace surf::workflow
