// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "agents/agent/ledger_view.hpp"
#include "agents/safety/trajectory_index.hpp"
#include "idl/negotiation.h"

namespace sidestep {

/// What the other robots nearby may be executing, as the coordinator last published it. The coordinator has
/// the last word; this is for proposing what it will grant. Allocates nothing once warm.
class Neighbours {
 public:
  explicit Neighbours(RobotId self) : self_(self) {}

  /// From now on versions that begin farther than `horizon_m` from `here` are left out.
  void look_about(const Vec2& here_m, double horizon_m);
  /// Takes over a page of the ledger, unless it is older than what is known of that page. `beside`, if any,
  /// is where the page's readers share their view of it.
  void on_page(const msg::LedgerPage& page, std::shared_ptr<void>* beside = nullptr);

  /// Makes the crowd those that begin within `horizon_m` of `here`. Valid until the next page.
  void gather(const Vec2& here_m, double horizon_m, TrajectoryIndex& crowd) const;
  /// The newest version of each of those that begin within `horizon_m`. Valid until the next page, or call.
  std::span<const Version* const> newest(const Vec2& here_m, double horizon_m);
  /// Where the nearest others stand, and will until somebody grants them something: those who have been at
  /// rest since `since`, at most `most` of them, in the order of their ids. Valid until the next call.
  std::span<const Vec2> standing(Time since, const Vec2& here_m, std::size_t most);
  std::uint64_t invalid() const { return invalid_; }

 private:
  struct Page {
    Epoch epoch = 0;
    std::uint64_t number = 0;
    std::shared_ptr<LedgerView> view;
    std::vector<std::uint32_t> held;  // what of the view was within the horizon
  };
  void take(const msg::LedgerPage& message, Page& page, std::shared_ptr<void>* beside);
  struct Stand {
    RobotId robot;
    Vec2 place_m;
    double distance2;
  };
  /// Whether any of the robot's versions ends after `since`.
  bool moves(RobotId robot, Time since) const;

  /// Nothing is held of the page, nor will be.
  bool is_of_no_concern(const msg::LedgerPage& page) const;

  // Most pages are about places far away: what tells that is together, first in memory.
  Vec2 here_m_{0, 0};
  double horizon_m_ = 0;
  std::uint64_t in_use_ = 0;  // bit k: of page k something is held
  RobotId self_;
  std::vector<Page> pages_;
  std::vector<Stand> standing_;
  std::vector<Vec2> places_;
  std::vector<const Version*> newest_;
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
