// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_input.hpp"

#include <fmt/core.h>

namespace sidestep {
namespace {

constexpr Duration kSilence{3'000'000'000};
constexpr double kSameField_m = 0.05;

}  // namespace

LeagueInput::LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueAddress& from, VisionNode& to)
    : bus_(bus),
      address_(from),
      field_(scenario.field),
      node_(to),
      source_(scenario),
      receiver_(league::multicast_endpoint(from.endpoint), from.interface) {
  bus.watch(receiver_.descriptor(), [this] {
    receiver_.receive([this](std::span<const std::byte> datagram, const league::Endpoint& sender) {
      take(datagram, sender);
    });
  });
  fmt::print(stderr, "sidestep-vision: reads the league's packets of {} on {}\n", from.endpoint,
             from.interface);
  bus.at(bus.now() + kSilence, [this] { report_silence(); });
}

void LeagueInput::take(std::span<const std::byte> datagram, const league::Endpoint& from) {
  const msg::DetectionFrame* const frame = source_.take(datagram, from, bus_.now());
  if (frame) node_.take(*frame);
  if (source_.refusal() != league::Refusal::kNone) report_refusal(from);
  if (source_.field() && !has_reported_field_) report_field();
}

void LeagueInput::report_silence() {
  if (source_.counts().packets > 0) return;
  fmt::print(stderr, "sidestep-vision: no packet has come to {} on the interface {} yet\n", address_.endpoint,
             address_.interface);
}

void LeagueInput::report_refusal(const league::Endpoint& from) {
  if (source_.refused() < next_report_) return;
  next_report_ *= 10;
  fmt::print(stderr, "sidestep-vision: {} packet(s) refused so far; the latest, from {}: {}\n",
             source_.refused(), to_text(from), in_words(source_.refusal()));
}

void LeagueInput::report_field() {
  has_reported_field_ = true;
  const league::FieldSize& theirs = *source_.field();
  if (std::abs(theirs.length_m - field_.length_m) <= kSameField_m &&
      std::abs(theirs.width_m - field_.width_m) <= kSameField_m) {
    return;
  }
  fmt::print(stderr, "sidestep-vision: the sender's field is {:g} x {:g} m, the scenario's {:g} x {:g} m\n",
             theirs.length_m, theirs.width_m, field_.length_m, field_.width_m);
}

}  // namespace sidestep
