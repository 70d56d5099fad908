// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_session.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <set>

#include "common/file/console.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/network_text.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/run/order/order_text.hpp"

namespace sidestep {
namespace {

// Discovery takes up to half a second, and so does a takeover.
constexpr Duration kAnswerTimeout = std::chrono::seconds(5);
// Coordinators repeat their memories once a second.
constexpr Duration kMemoryTimeout = std::chrono::milliseconds(2500);
constexpr Duration kPollPeriod = std::chrono::milliseconds(20);
constexpr Duration kHindrancePeriod = std::chrono::milliseconds(200);
// Shorter hindrances are not worth a line: a takeover by another coordinator takes less time.
constexpr Duration kMinHindrance = std::chrono::seconds(1);

bool is_answered(const SentOrder& sent) { return sent.phase != OrderPhase::kSent; }
bool is_over(const SentOrder& sent) { return is_final(sent.phase); }

}  // namespace

ClientId client_of(const OrderOptions& options) {
  return options.client.empty() ? static_cast<ClientId>(Sender::kOperator) : client_id(options.client);
}

DdsSettings dds_of(const OrderOptions& options) {
  DdsSettings dds = options.dds;
  if (!options.client.empty()) dds.identity = {Role::kClient, 0, 0, options.client};
  return dds;
}

OrderSession::OrderSession(const OrderOptions& options)
    : options_(options),
      bus_(dds_of(options)),
      stop_signals_([this] {
        is_interrupted_ = true;
        bus_.stop();
      }),
      client_(bus_, client_of(options), options.client) {
  client_.on_change([this](const SentOrder& sent) { on_change(sent); });
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) {
    if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING)
      coordinator_ = state.header().sender();
  });
}

template <typename Condition>
bool OrderSession::are_all(Condition condition) const {
  return std::ranges::all_of(handles_, [&](OrderHandle handle) { return condition(*client_.find(handle)); });
}

bool OrderSession::is_done() const {
  if (!are_all(options_.waits ? is_over : is_answered)) return false;
  return !names_holders_ || client_.remembered_orders().has_value();
}

void OrderSession::stop_if_done() {
  if (is_done()) bus_.stop();
}

void OrderSession::on_change(const SentOrder& sent) {
  // Its phase is not news while the robot is known not to drive.
  if (is_over(sent) || shown_[sent.handle].printed.empty()) print_output("{}\n", to_line(sent));
  stop_if_done();
}

void OrderSession::print_hindrances() {
  for (const OrderHandle handle : handles_) {
    const SentOrder& sent = *client_.find(handle);
    if (!is_answered(sent) || is_over(sent)) continue;
    const std::vector<Hindrance> hindrances = watch_->hindrances(sent.order.robot);
    Shown& shown = shown_[handle];
    if (const std::string text = lasting_text(hindrances); text != shown.latest) {
      shown.latest = text;
      shown.latest_since = bus_.now();
    }
    if (shown.latest == shown.printed || bus_.now() - shown.latest_since < kMinHindrance) continue;
    shown.printed = shown.latest;
    print_output("{}\n", to_line(sent, hindrances));
  }
}

void OrderSession::print_remaining_holds(const SentOrder& resume) const {
  std::optional<OrderBook> remembered = client_.remembered_orders();
  if (!remembered) return;
  (void)remembered->merge({resume.order});  // memories may be older than it
  const RobotId robot = resume.order.robot;
  const std::vector<Order> holds = robot == kAllRobots ? remembered->holds() : remembered->holds_of(robot);
  if (!holds.empty()) print_output("{}\n", still_held_text(holds));
}

int OrderSession::finish_resume(OrderHandle handle) {
  names_holders_ = true;
  call_periodically(bus_, kPollPeriod, [this] { stop_if_done(); });
  const int code = finish({handle});
  if (code == 0) print_remaining_holds(*client_.find(handle));
  return code;
}

int OrderSession::finish(const std::vector<OrderHandle>& handles) {
  handles_ = handles;
  if (options_.waits) {
    watch_.emplace(bus_, client_, !options_.dds.keys.empty());
    for (const OrderHandle handle : handles_) watch_->watch(client_.find(handle)->order.robot);
    call_periodically(bus_, kHindrancePeriod, [this] { print_hindrances(); });
  }
  const Time deadline = options_.timeout_s ? bus_.now() + from_seconds(*options_.timeout_s) : Time::max();
  bus_.run_until(std::min(deadline, bus_.now() + kAnswerTimeout));
  if (options_.waits && are_all(is_answered) && !are_all(is_over) && !is_interrupted_)
    bus_.run_until(deadline);
  if (!are_all(is_over) && bus_.now() >= deadline) {
    print_timeout();
    return kExitFailure;
  }
  if (!are_all(is_answered)) {
    fmt::print(stderr, "sidestep: {}\n",
               is_interrupted_ ? "the order may take effect, but is not confirmed yet" : unconfirmed_text());
    return kExitFailure;
  }
  if (options_.waits && !are_all(is_over)) {
    fmt::print(stderr, "sidestep: {}\n", open_text());
    return kExitFailure;
  }
  const auto is_good = [this](const SentOrder& sent) {
    return options_.waits ? sent.phase == OrderPhase::kArrived : sent.phase != OrderPhase::kRefused;
  };
  return are_all(is_good) ? 0 : kExitFailure;
}

std::optional<std::vector<Order>> OrderSession::zones_without(std::uint32_t number) {
  // The memory of a standby may lack a zone that was accepted a moment ago, that of the other may not.
  const auto is_told = [this] { return coordinator_ && client_.has_memory_of(*coordinator_); };
  for (const Time deadline = bus_.now() + kMemoryTimeout; bus_.now() < deadline && !is_told();) {
    bus_.run_until(bus_.now() + kPollPeriod);
    if (client_.remembered_orders() && client_.may_have_zone(number)) return std::nullopt;
  }
  const auto remembered = client_.remembered_orders();
  return remembered ? std::optional(remembered->zones()) : std::nullopt;
}

void OrderSession::print_timeout() const {
  for (const OrderHandle handle : handles_) {
    const SentOrder& sent = *client_.find(handle);
    if (is_over(sent)) continue;
    const auto hindrances =
        watch_ && is_answered(sent) ? watch_->hindrances(sent.order.robot) : std::vector<Hindrance>();
    fmt::print(stderr, "sidestep: after {:g} s: {}\n", *options_.timeout_s, to_line(sent, hindrances));
  }
  const std::string open = open_text();
  fmt::print(stderr, "sidestep: {}\n", open.empty() ? unconfirmed_text() : open);
}

std::string OrderSession::open_text() const {
  std::set<RobotId> driving, waiting;
  for (const OrderHandle handle : handles_) {
    const SentOrder& sent = *client_.find(handle);
    if (!is_answered(sent) || is_over(sent)) continue;
    const RobotId robot = sent.order.robot;
    const bool waits = sent.phase == OrderPhase::kBlocked || (watch_ && !watch_->hindrances(robot).empty());
    (waits ? waiting : driving).insert(robot);
  }
  return open_orders_text(driving, waiting, options_.client);
}

std::string OrderSession::unconfirmed_text() const {
  return coordinator_
             ? "the order may take effect, but is not confirmed: the coordinator waits for an agent that "
               "remembers the order (for a hold: the agent of a held robot). Check that such an agent is "
               "running"
             : "no active coordinator answers " + network_text(options_.dds);
}

}  // namespace sidestep
