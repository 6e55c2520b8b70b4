// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace surf::workflow {

/// What the processes of one machine that do a job together share. All of them call the same
/// functions in the same order.
class NodeMemory {
 public:
  virtual ~NodeMemory() = default;

  /// Whether this process is the one that fills what is shared.
  virtual bool is_first() const = 0;
  /// How many share, at least 2.
  virtual int processes() const = 0;
  /// From the first to the others.
  virtual void tell(std::string& bytes) = 0;
  /// Memory that begins at a multiple of 64 bytes and lasts as long as it is held; `bytes` is the
  /// same for all. The first one fills it, then all call `share`, and from then on it is read only.
  virtual std::shared_ptr<std::byte> allocate(std::size_t bytes) = 0;
  virtual void share(std::byte* memory, std::size_t bytes) = 0;
};

}  // namespace surf::workflow
