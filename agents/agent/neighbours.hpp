// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "agents/agent/received_page.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "common/protocol/drop_counters.hpp"

namespace sidestep {

/// The versions that nearby robots may be executing, from the coordinator's ledger pages. The agent uses them
/// to propose candidates that are likely to be granted; safety rests on the coordinator's verdict alone.
/// Allocates nothing once warm.
class Neighbours {
 public:
  explicit Neighbours(RobotId self) : self_(self) {}

  /// Filters pages that arrive from now on: versions that start farther than `horizon_m` from `centre_m` are
  /// dropped, except those of robots that find_stationary() has returned.
  void set_horizon(const Vec2& centre_m, double horizon_m);
  /// Stores a page of the ledger, unless a newer message with that page is already stored. Decodes its
  /// versions only if the page is within the horizon.
  void on_page(const ReceivedPage& received);

  /// Fills the index with the versions that start within `horizon_m` of `centre_m`. Valid until the next
  /// page.
  void collect(const Vec2& centre_m, double horizon_m, TrajectoryIndex& index) const;
  /// The newest version of each robot that has versions within `horizon_m`. Valid until the next page or
  /// call.
  std::span<const Version* const> newest(const Vec2& centre_m, double horizon_m);
  /// A robot at rest. `intent` is nullptr if the robot has no destination.
  struct Stationary {
    RobotId robot = 0;
    Vec2 position_m{0, 0};
    const Intent* intent = nullptr;
  };
  /// The robots that have been at rest since `since` and have no later version that moves. Returns the
  /// `max_count` nearest of these robots, sorted by robot id. Valid until the next page or call. Robots that
  /// were found once are also found beyond the horizon, until they move: if they were forgotten there, a
  /// robot would choose its route by them only when it is near them, and could turn around for ever.
  std::span<const Stationary> find_stationary(Time since, const Vec2& centre_m, std::size_t max_count);
  /// Whether a robot that newest() has returned has been at rest since `since` and has no later version that
  /// moves.
  bool is_at_rest(RobotId robot, Time since) const { return !is_moving(robot, since); }
  /// Number of versions within the horizon that could not be decoded.
  std::uint64_t invalid() const { return invalid_; }
  void count_drops(DropCounters& drops) const;

 private:
  struct Page {
    Epoch epoch = 0;
    std::uint64_t number = 0;
    std::shared_ptr<DecodedLedgerPage> decoded;
    std::vector<std::uint32_t> nearby;  // indices in `decoded` of the versions within the horizon
  };
  void store(const ReceivedPage& received, Page& page);
  bool is_remembered(RobotId robot) const;
  /// Whether any version of the robot ends after `since`.
  bool is_moving(RobotId robot, Time since) const;

  /// Whether the page is out of range and nothing is stored from its previous message.
  bool can_skip(const ReceivedPage& received) const;

  // Most pages are out of range. The members that can_skip() reads come first, to share a cache line.
  Vec2 centre_m_{0, 0};
  double horizon_m_ = 0;
  std::uint64_t nonempty_pages_ = 0;  // bit k: versions of page k are stored
  RobotId self_;
  std::vector<Page> pages_;
  std::vector<Stationary> stationary_;
  std::vector<RobotId> remembered_;  // found at rest by the last search
  std::vector<const Version*> newest_;
  std::uint64_t invalid_ = 0, late_ = 0;
};

}  // namespace sidestep
