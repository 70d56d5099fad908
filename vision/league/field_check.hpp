// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/geometry/field.hpp"
#include "common/league/field_geometry.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Decides whether frames of a sender may be used: only if its field has the scenario's size, because on
/// another field robots drive against walls, or the scenario belongs to another simulator.
class FieldCheck {
 public:
  /// Larger differences of length or width are an error.
  static constexpr double kTolerance_m = 0.05;
  /// Frames of a sender that sends no geometry for this long are used without it.
  static constexpr Duration kMaxWait{4'000'000'000};

  explicit FieldCheck(const Field& scenario) : scenario_(scenario) {}

  /// Handles a geometry packet of the sender.
  void on_field(const league::FieldSize& sender) { sender_ = sender; }
  bool differs() const;
  /// Whether a frame that arrives now may be used.
  [[nodiscard]] bool may_use_frame(Time now);
  /// What differs, and what to do. Precondition: differs().
  std::string problem() const;

 private:
  Field scenario_;
  std::optional<league::FieldSize> sender_;
  std::optional<Time> first_frame_at_;
};

}  // namespace sidestep
