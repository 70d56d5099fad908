// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/motion/version.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// An opponent or a person, as vision last observed it.
struct ObservedObstacle {
  std::uint32_t track = 0;  ///< numbered by the vision process, never reused
  Time observed_at{};
  Vec2 position_m{0, 0};
  double radius_m = 0;
  double position_variance_m2 = 0;  ///< variance on each axis
  Vec2 velocity_mps{0, 0};          ///< as sent: not checked, not even for NaN
};

/// A list of obstacles. All numbers are within bounds, but times may be arbitrary.
struct ObstacleObservations {
  Incarnation vision = 0;  ///< incarnation of the vision process
  Time valid_at{};
  /// No unlisted obstacle is nearer than this to any robot in the world state of the same time; see
  /// ObstacleList in idl/vision.idl. kCompleteEverywhere_m: there are no unlisted obstacles.
  double complete_within_m = 0;
  std::span<const ObservedObstacle> obstacles{};
};

/// Decodes untrusted lists of obstacles. Allocates only in the constructor.
class ObstacleListDecoder {
 public:
  ObstacleListDecoder() { obstacles_.reserve(msg::MAX_OBSTACLES); }

  /// Returns nullopt if the list is not from vision, is too long, or contains an impossible number: dropping
  /// a single obstacle would make the list incomplete. Valid until the next call.
  [[nodiscard]] std::optional<ObstacleObservations> decode(const msg::ObstacleList& message);

 private:
  std::vector<ObservedObstacle> obstacles_;
};

}  // namespace sidestep
