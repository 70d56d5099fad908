// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/place/place_floor.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <stdexcept>

#include "common/file/console.hpp"
#include "common/league/unicast.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/run/place/league_placement.hpp"
#include "vision/league/sender_choice.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(20);

using Receivers = std::vector<std::unique_ptr<league::MulticastReceiver>>;

Receivers receivers_on_all_interfaces(const league::Endpoint& group) {
  Receivers receivers;
  for (const league::NetworkInterface& interface : league::network_interfaces()) {
    try {
      receivers.push_back(std::make_unique<league::MulticastReceiver>(group, interface.address));
    } catch (const std::runtime_error&) {  // some interfaces have no multicast
    }
  }
  if (receivers.empty())
    throw std::runtime_error(to_text(group) + ": no network interface of this machine has multicast");
  return receivers;
}

Receivers receivers_of(const Scenario& scenario, const PlaceOptions& options) {
  const league::Endpoint group = league::parse_multicast_endpoint(options.vision);
  const bool is_default = options.interfaces.empty();
  if (is_default ? scenario.vision.has_league_everywhere : std::ranges::count(options.interfaces, "all") > 0)
    return receivers_on_all_interfaces(group);
  Receivers receivers;
  for (const std::string& interface :
       is_default ? std::vector<std::string>{league::kLeagueInterface} : options.interfaces)
    receivers.push_back(std::make_unique<league::MulticastReceiver>(group, interface));
  return receivers;
}

std::vector<league::Endpoint> senders_of(const PlaceOptions& options) {
  std::vector<league::Endpoint> senders;
  for (const std::string& text : options.senders) senders.push_back(parse_sender(text));
  return senders;
}

/// Connects a placement to the simulator's control port and to its vision packets.
class PlacedFloor {
 public:
  PlacedFloor(const Scenario& scenario, const PlaceOptions& options)
      : placement_(scenario),
        control_(league::parse_unicast_endpoint(options.control)),
        choice_(senders_of(options)),
        receivers_(receivers_of(scenario, options)) {
    for (const auto& receiver : receivers_) {
      loop_.watch(receiver->descriptor(), [this, &ear = *receiver] {
        ear.receive([this](std::span<const std::byte> datagram, const league::Endpoint& sender) {
          on_vision(datagram, sender);
        });
      });
    }
    loop_.watch(socket_.descriptor(), [this] {
      socket_.receive([this](std::span<const std::byte> datagram, const league::Endpoint& from) {
        const auto answer = league::decode_simulator_response(datagram);
        if (from == control_ && answer.packet) placement_.on_answer(*answer.packet);
      });
    });
  }

  /// Returns whether vision agrees in time.
  bool place(Duration timeout) {
    const StopSignals stop_signals([this] { loop_.stop(); });
    const std::function<void()> step = [&] {
      // A datagram that cannot be sent is replaced by the next one.
      if (const auto command = placement_.update(EventLoop::now()))
        (void)socket_.send(encode(*command), control_);
      if (placement_.is_done()) return loop_.stop();
      loop_.at(EventLoop::now() + kPeriod, step);
    };
    step();
    loop_.run_until(EventLoop::now() + timeout);
    return placement_.is_done();
  }
  const LeaguePlacement& placement() const { return placement_; }

 private:
  void on_vision(std::span<const std::byte> datagram, const league::Endpoint& sender) {
    const auto packet = league::decode_vision(datagram);
    if (!packet.packet || !packet.packet->detection) return;
    if (choice_.admit(sender, EventLoop::now()))
      placement_.on_frame(*packet.packet->detection, EventLoop::now());
  }

  EventLoop loop_;
  LeaguePlacement placement_;
  league::Endpoint control_;
  league::UnicastSocket socket_{std::nullopt};
  SenderChoice choice_;
  Receivers receivers_;
};

}  // namespace

int place_floor(const Scenario& scenario, const PlaceOptions& options) {
  PlacedFloor floor(scenario, options);
  const bool is_done = floor.place(from_seconds(options.timeout_s));
  const LeaguePlacement& placement = floor.placement();
  if (!is_done) {
    print_to(stderr, "sidestep: the floor at {} is not as in {} (vision packets of {}): {}\n",
             options.control, scenario.name, options.vision, placement.problem());
    return kExitFailure;
  }
  print_to(stderr, "placed {} robot(s) and removed {} by {}; vision agrees with {}\n", placement.placed(),
           placement.removed(), options.control, scenario.name);
  return 0;
}

}  // namespace sidestep
