// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "cascades/cascade_format.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// The books of one replayed primary. A node that is passed over counts as a whole: what it
/// generates is in its header. So the walk enters a node's generation when it comes to it, and
/// takes off what an electron that is gone does not generate.
class Ledger {
 public:
  explicit Ledger(Balance& balance) : balance_(balance) {}

  void begin(double energy_ev) {
    generated_ = left_ = lost_ = 0;
    energy_in_ = energy_ev;
    energy_out_ = 0;
    generated_energy_ = 0;
    ++balance_.incident;
    balance_.incident_energy.add(energy_ev);
  }

  void end(bool hit) {
    if (!hit) ++balance_.missed;
    balance_.generated += generated_;
    balance_.absorbed += 1 + generated_ - left_ - lost_;
    balance_.generated_energy.add(generated_energy_);
    balance_.deposited_energy.add(energy_in_ + generated_energy_ - energy_out_);
  }

  /// All that a node generates, or no more than was generated so far.
  void add(const PackedNode& node) {
    generated_ += node.generated;
    generated_energy_ += node.generated_ev;
  }
  void take_off(const PackedNode& node) {
    generated_ -= node.generated;
    generated_energy_ -= node.generated_ev;
  }
  /// One electron of this total energy.
  void add(double total_ev) {
    generated_ += 1;
    generated_energy_ += total_ev;
  }
  void take_off(double total_ev) {
    generated_ -= 1;
    generated_energy_ -= total_ev;
  }

  /// An electron has left for good.
  void escape(double energy_ev) {
    ++left_;
    energy_out_ += energy_ev;
    balance_.escaped_energy.add(energy_ev);
  }

  /// Direct simulation follows the electron from here, and keeps books of its own of what comes of
  /// it.
  void hand_over(double total_ev) {
    ++left_;
    energy_out_ += total_ev;
    ++balance_.handed_over;
  }

  void lose(LossCause cause, double total_ev) {
    ++lost_;
    energy_out_ += total_ev;
    ++balance_.lost[static_cast<std::size_t>(cause)];
    balance_.lost_energy.add(total_ev);
  }

 private:
  Balance& balance_;
  std::int64_t generated_ = 0, left_ = 0, lost_ = 0;
  double energy_in_ = 0, energy_out_ = 0, generated_energy_ = 0;
};

}  // namespace surf::mc
