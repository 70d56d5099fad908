// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/other_run.hpp"

#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <unistd.h>

#include "common/keys/key_folder.hpp"
#include "common/messaging/clock_codec.hpp"
#include "common/protocol/process_names.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kListeningTime = 500ms, kAnswerTime = 2s, kProbePeriod = 100ms;

/// Listens for a coordinator in the domain, and asks it for its host and scenario.
class OtherRun {
 public:
  explicit OtherRun(const DdsSettings& dds) : bus_(dds), client_(client_id(fmt::format("run {}", getpid()))) {
    bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) {
      if (is_coordinator(state.header().sender())) coordinator_ = state.header();
    });
    bus_.subscribe(topics::kClockReading, [this](const msg::ClockReading& message) {
      const auto answer = decode(message);
      if (answer && answer->client == client_ && coordinator_ && answer->process == coordinator_->sender())
        answer_ = answer;
    });
  }

  /// Listens for kListeningTime. Returns whether a coordinator was heard.
  bool listen() {
    bus_.run_until(bus_.now() + kListeningTime);
    return coordinator_.has_value();
  }

  /// "run of crossing on host lab-3 is using it, whose coordinator has been running since 2026-11-28
  /// 03:10:17". Precondition: listen() has heard one.
  std::string describe() {
    ask();
    const std::string names =
        answer_ ? fmt::format(" of {} on host {}", answer_->scenario, answer_->host) : std::string();
    // Incarnations are readings of the clock at the start of a process.
    return fmt::format("another run{} is using it, whose {} has been running since {}", names,
                       process_name(coordinator_->sender()),
                       date_text(time_from_ns(static_cast<std::int64_t>(coordinator_->incarnation()))));
  }

 private:
  void ask() {
    if (!bus_.may_write(topics::kClockProbe, 0)) return;  // for example with the keys of a judge
    Writer<msg::ClockProbe> writer = bus_.advertise(topics::kClockProbe);
    msg::ClockProbe probe;
    probe.client(client_);
    probe.header().sender(client_);
    for (const Time until = bus_.now() + kAnswerTime; !answer_ && bus_.now() < until;) {
      writer.publish(probe, bus_.now());
      bus_.run_until(bus_.now() + kProbePeriod);
    }
  }

  DdsBus bus_;
  const std::uint32_t client_;
  std::optional<msg::Header> coordinator_;
  std::optional<ClockAnswer> answer_;
};

/// Uses the identity of the operator, who may ask, if the folder has the operator's keys.
DdsSettings as_operator(const DdsSettings& given) {
  DdsSettings dds = given;
  dds.identity = {Role::kOperator};
  try {
    if (!dds.keys.empty()) (void)key_folder_of(dds.keys, dds.identity);
  } catch (const std::invalid_argument&) {
    return given;
  }
  return dds;
}

}  // namespace

void require_free_domain(const DdsSettings& dds) {
  OtherRun other(as_operator(dds));
  if (other.listen())
    throw std::invalid_argument(
        fmt::format("DDS domain {} is in use: {}; end that run, or choose another --domain", dds.domain,
                    other.describe()));
}

}  // namespace sidestep
