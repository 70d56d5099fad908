// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_input.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

#include "common/log/log.hpp"

namespace sidestep {
namespace {

constexpr Duration kSilenceTimeout{3'000'000'000};

std::vector<league::Endpoint> parsed_senders(const std::vector<std::string>& texts) {
  std::vector<league::Endpoint> senders;
  for (const std::string& text : texts) senders.push_back(parse_sender(text));
  return senders;
}

}  // namespace

LeagueInput::LeagueInput(DdsBus& bus, const Scenario& scenario, const LeagueReception& reception,
                         VisionNode& node)
    : bus_(bus),
      reception_(reception),
      node_(node),
      source_(scenario, parsed_senders(reception.senders)),
      field_(scenario.field) {
  if (std::ranges::count(reception.interfaces, "all") > 0)
    listen_everywhere();
  else
    for (const std::string& interface : reception.interfaces) listen_on(interface);
  node_.add_drop_source([this](DropCounters& drops) { source_.count_drops(drops); });
  bus.at(bus.now() + kSilenceTimeout, [this] { report_silence(); });
}

void LeagueInput::listen_everywhere() {
  for (const league::NetworkInterface& interface : league::network_interfaces()) {
    try {
      listen_on(interface.address);
    } catch (const std::runtime_error& error) {  // some interfaces have no multicast
      log(LogLevel::kWarning,
          fmt::format("vision does not listen on interface {}: {}", interface.name, error.what()));
    }
  }
}

void LeagueInput::listen_on(const std::string& interface) {
  Ear& ear = *ears_.emplace_back(
      std::make_unique<Ear>(league::parse_multicast_endpoint(reception_.endpoint), interface));
  bus_.watch(ear.receiver.descriptor(), [this, &ear] {
    ear.receiver.receive([&](std::span<const std::byte> datagram, const league::Endpoint& sender) {
      if (!ear.has_heard) report_heard(ear, sender);
      handle(datagram, sender);
    });
  });
  log(LogLevel::kInfo,
      fmt::format("receiving league packets from {} on interface {}", reception_.endpoint, interface));
}

void LeagueInput::handle(std::span<const std::byte> datagram, const league::Endpoint& sender) {
  const msg::DetectionFrame* const frame = source_.decode(datagram, sender, bus_.now());
  if (source_.field()) field_.on_field(*source_.field());
  check_field();
  if (frame && (reception_.may_have_other_field || field_.may_use_frame(bus_.now()))) {
    has_used_frame_ = true;
    node_.add_frame(*frame, source_.date_uncertainty());
  }
  if (source_.error() != league::DecodeError::kNone) report_rejection(sender);
  if (source_.choice().refused_packets() >= next_sender_report_) report_other_sender();
  if (source_.clock_jumps() > reported_jumps_) report_clock_jump(sender);
  report_clock();
}

void LeagueInput::check_field() {
  if (!field_.differs()) {
    has_reported_field_ = false;
    return;
  }
  if (!has_used_frame_ && !reception_.may_have_other_field) throw std::invalid_argument(field_.problem());
  if (has_reported_field_) return;
  has_reported_field_ = true;
  if (reception_.may_have_other_field)
    log(LogLevel::kInfo, "the sender's field differs from the scenario's, as --other-field allows");
  else
    log(LogLevel::kError, fmt::format("frames are not used: {}", field_.problem()));
}

void LeagueInput::report_heard(Ear& ear, const league::Endpoint& sender) {
  ear.has_heard = true;
  log(LogLevel::kInfo, fmt::format("hears sender {} on interface {}", to_text(sender), ear.interface));
}

void LeagueInput::report_silence() {
  if (source_.counts().packets > 0) return;
  std::vector<std::string> deaf;
  for (const league::NetworkInterface& interface : league::network_interfaces())
    if (std::ranges::none_of(ears_, [&](const auto& ear) { return ear->interface == interface.address; }))
      deaf.push_back(fmt::format("{} ({})", interface.address, interface.name));
  std::string text = fmt::format("no packet received from {} so far", reception_.endpoint);
  if (!deaf.empty())
    text += fmt::format(
        "; a sender may use an interface on which vision does not listen, {}: allow it with "
        "--league-interface, or "
        "all with --league-interface all",
        fmt::join(deaf, ", "));
  log(LogLevel::kWarning, text);
}

void LeagueInput::report_other_sender() {
  const SenderChoice& choice = source_.choice();
  next_sender_report_ = choice.refused_packets() * 10;
  log(LogLevel::kWarning,
      fmt::format(
          "{} packet(s) of other senders not used so far, the latest of {}; {} is used: name the right one "
          "with --league-sender ADDRESS[:PORT]",
          choice.refused_packets(), to_text(*choice.refused()),
          choice.used() ? to_text(*choice.used()) : "none"));
}

void LeagueInput::report_rejection(const league::Endpoint& sender) {
  if (source_.rejected() < next_report_) return;
  next_report_ *= 10;
  log(LogLevel::kWarning, fmt::format("{} packet(s) rejected so far; latest, from {}: {}", source_.rejected(),
                                      to_text(sender), describe(source_.error())));
}

void LeagueInput::report_clock() {
  const SenderClock* const clock = source_.clock();
  if (!clock || clock->kind() == reported_kind_ || !clock_reports_.admit(bus_.now())) return;
  reported_kind_ = clock->kind();
  log(reported_kind_ == SenderClockKind::kSteady ? LogLevel::kInfo : LogLevel::kWarning,
      fmt::format("the clock of sender {} {}", to_text(*source_.detecting_sender()), describe(*clock)));
}

void LeagueInput::report_clock_jump(const league::Endpoint& sender) {
  reported_jumps_ = source_.clock_jumps();
  log(LogLevel::kWarning, fmt::format("the clock of sender {} has jumped", to_text(sender)));
}

}  // namespace sidestep
