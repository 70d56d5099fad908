// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/messaging/dds/bus.hpp"
#include "common/time/rate_limit.hpp"
#include "vision/league/field_check.hpp"
#include "vision/league/league_source.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep {

/// Where and from whom the league's packets are received.
struct LeagueReception {
  std::string endpoint;                 ///< ADDRESS:PORT of the multicast group
  std::vector<std::string> interfaces;  ///< addresses of network interfaces, or "all"
  std::vector<std::string> senders;     ///< ADDRESS or ADDRESS:PORT of the senders to use; empty: the first
  bool may_have_other_field = false;    ///< the sender's field may differ from the scenario's
};

/// Feeds a vision node with detections from the league's multicast, and logs problems. Throws
/// std::invalid_argument out of the bus if the sender's field is another than the scenario's, before it has
/// used a frame. Later it uses no frame while the fields differ. Precondition: the bus makes no callbacks
/// after this object's destruction. The constructor throws what MulticastReceiver and LeagueSource throw.
class LeagueInput {
 public:
  LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueReception& reception, VisionNode& node);
  LeagueInput(const LeagueInput&) = delete;
  LeagueInput& operator=(const LeagueInput&) = delete;

 private:
  /// The receiver of one interface.
  struct Ear {
    Ear(const league::Endpoint& group, const std::string& address)
        : interface(address), receiver(group, address) {}

    std::string interface;
    league::MulticastReceiver receiver;
    bool has_heard = false;
  };
  void listen_everywhere();
  void listen_on(const std::string& interface);
  void handle(std::span<const std::byte> datagram, const league::Endpoint& sender);
  void check_field();
  void report_heard(Ear& ear, const league::Endpoint& sender);
  void report_silence();
  void report_rejection(const league::Endpoint& sender);
  void report_other_sender();
  void report_clock_jump(const league::Endpoint& sender);
  void report_clock();

  DdsBus& bus_;
  LeagueReception reception_;
  VisionNode& node_;
  LeagueSource source_;
  FieldCheck field_;
  std::vector<std::unique_ptr<Ear>> ears_;
  std::uint64_t next_report_ = 1;  ///< number of rejected packets at which the next report is due
  std::uint64_t next_sender_report_ = 1;
  bool has_used_frame_ = false;
  bool has_reported_field_ = false;
  std::uint64_t reported_jumps_ = 0;
  SenderClockKind reported_kind_ = SenderClockKind::kSteady;
  RateLimit clock_reports_{1, std::chrono::seconds(5)};
};

}  // namespace sidestep
