// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_input.hpp"

#include <fmt/core.h>

#include "common/log/log.hpp"

namespace sidestep {
namespace {

constexpr Duration kSilenceTimeout{3'000'000'000};
constexpr double kFieldTolerance_m = 0.05;

}  // namespace

LeagueInput::LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueAddress& address,
                         VisionNode& node)
    : bus_(bus),
      address_(address),
      field_(scenario.field),
      node_(node),
      source_(scenario),
      receiver_(league::parse_multicast_endpoint(address.endpoint), address.interface) {
  bus.watch(receiver_.descriptor(), [this] {
    receiver_.receive([this](std::span<const std::byte> datagram, const league::Endpoint& sender) {
      handle(datagram, sender);
    });
  });
  log(LogLevel::kInfo,
      fmt::format("receiving league packets from {} on interface {}", address.endpoint, address.interface));
  node_.add_drop_source([this](DropCounters& drops) { source_.count_drops(drops); });
  bus.at(bus.now() + kSilenceTimeout, [this] { report_silence(); });
}

void LeagueInput::handle(std::span<const std::byte> datagram, const league::Endpoint& sender) {
  const msg::DetectionFrame* const frame = source_.decode(datagram, sender, bus_.now());
  if (frame) node_.add_frame(*frame, source_.date_uncertainty());
  if (source_.error() != league::DecodeError::kNone) report_rejection(sender);
  if (source_.field() && !has_reported_field_) report_field();
  if (source_.clock_jumps() > reported_jumps_) report_clock_jump(sender);
  report_clock(sender);
}

void LeagueInput::report_silence() {
  if (source_.counts().packets > 0) return;
  log(LogLevel::kWarning, fmt::format("no packet received from {} on interface {} so far", address_.endpoint,
                                      address_.interface));
}

void LeagueInput::report_rejection(const league::Endpoint& sender) {
  if (source_.rejected() < next_report_) return;
  next_report_ *= 10;
  log(LogLevel::kWarning, fmt::format("{} packet(s) rejected so far; latest, from {}: {}", source_.rejected(),
                                      to_text(sender), describe(source_.error())));
}

void LeagueInput::report_field() {
  has_reported_field_ = true;
  const league::FieldSize& sender_field = *source_.field();
  if (std::abs(sender_field.length_m - field_.length_m) <= kFieldTolerance_m &&
      std::abs(sender_field.width_m - field_.width_m) <= kFieldTolerance_m) {
    return;
  }
  log(LogLevel::kWarning,
      fmt::format("the sender's field is {:g} x {:g} m, the scenario's is {:g} x {:g} m",
                  sender_field.length_m, sender_field.width_m, field_.length_m, field_.width_m));
}

void LeagueInput::report_clock(const league::Endpoint& sender) {
  const SenderClock* const clock = source_.clock();
  if (!clock || clock->kind() == reported_kind_ || !clock_reports_.admit(bus_.now())) return;
  reported_kind_ = clock->kind();
  log(reported_kind_ == SenderClockKind::kSteady ? LogLevel::kInfo : LogLevel::kWarning,
      fmt::format("the clock of sender {} {}", to_text(sender), describe(*clock)));
}

void LeagueInput::report_clock_jump(const league::Endpoint& sender) {
  reported_jumps_ = source_.clock_jumps();
  log(LogLevel::kWarning, fmt::format("the clock of sender {} has jumped", to_text(sender)));
}

}  // namespace sidestep
