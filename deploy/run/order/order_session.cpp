// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_session.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "common/process/exit_code.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/run/order/order_text.hpp"

namespace sidestep {
namespace {

// Discovery takes up to half a second, and so does a takeover.
constexpr Duration kAnswerTimeout = std::chrono::seconds(5);
// Coordinators repeat their memories once a second.
constexpr Duration kMemoryTimeout = std::chrono::milliseconds(2500);
constexpr Duration kPollPeriod = std::chrono::milliseconds(20);

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
      stop_signals_([this] { bus_.stop(); }),
      client_(bus_, client_of(options), options.client) {
  client_.on_change([this](const SentOrder& sent) {
    fmt::print("{}\n", to_line(sent));
    if (are_all(options_.waits ? is_over : is_answered)) bus_.stop();
  });
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) {
    is_coordinator_heard_ |= state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING;
  });
}

template <typename Condition>
bool OrderSession::are_all(Condition condition) const {
  return std::ranges::all_of(handles_, [&](OrderHandle handle) { return condition(*client_.find(handle)); });
}

int OrderSession::finish(const std::vector<OrderHandle>& handles) {
  handles_ = handles;
  const Time deadline = options_.timeout_s ? bus_.now() + from_seconds(*options_.timeout_s) : Time::max();
  bus_.run_until(std::min(deadline, bus_.now() + kAnswerTimeout));
  if (options_.waits && are_all(is_answered) && !are_all(is_over)) bus_.run_until(deadline);
  if (!are_all(is_over) && bus_.now() >= deadline) {
    print_timeout();
    return kExitFailure;
  }
  if (!are_all(is_answered)) {
    fmt::print(stderr, "sidestep: {}\n", unconfirmed_text());
    return kExitFailure;
  }
  const auto is_good = [this](const SentOrder& sent) {
    return options_.waits ? sent.phase == OrderPhase::kArrived : sent.phase != OrderPhase::kRefused;
  };
  return are_all(is_good) ? 0 : kExitFailure;
}

std::optional<std::vector<Order>> OrderSession::zones_without(std::uint32_t number) {
  const auto is_wanted = [&, client = client_of(options_)](const Order& zone) {
    return zone.client == client && zone.zone_number == number;
  };
  for (const Time deadline = bus_.now() + kMemoryTimeout; bus_.now() < deadline;) {
    bus_.run_until(bus_.now() + kPollPeriod);
    const auto remembered = client_.remembered_orders();
    if (remembered && std::ranges::any_of(remembered->zones(), is_wanted)) return std::nullopt;
  }
  const auto remembered = client_.remembered_orders();
  return remembered ? std::optional(remembered->zones()) : std::nullopt;
}

void OrderSession::print_timeout() const {
  for (const OrderHandle handle : handles_) {
    const SentOrder& sent = *client_.find(handle);
    if (!is_over(sent))
      fmt::print(stderr, "sidestep: after {:g} s: {}\n", *options_.timeout_s, to_line(sent));
  }
  fmt::print(stderr, "sidestep: the robots drive on; `sidestep cancel ROBOT` ends an order\n");
}

std::string OrderSession::unconfirmed_text() const {
  return is_coordinator_heard_
             ? "the order may take effect, but is not confirmed: the coordinator waits for an agent that "
               "remembers the order (for a hold: the agent of a held robot). Check that such an agent is "
               "running"
             : "no active coordinator answers on this domain and interface";
}

}  // namespace sidestep
