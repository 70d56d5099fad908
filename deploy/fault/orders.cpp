// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/orders.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <thread>

#include "common/config/scenario.hpp"
#include "common/messaging/dds/lease.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/motion/version.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kDiscovery = 5s;  ///< more than the participants' announcements are apart
constexpr Duration kQuiet = 1500ms;  ///< nobody new for so long: all are known
constexpr Duration kMissing = 2s;    ///< after its lease one that has died is missed at the latest
constexpr auto kLook = 10ms;

template <typename Condition>
bool wait_until(Condition condition) {
  const Time deadline = EventLoop::now() + kDiscovery;
  while (!condition()) {
    if (EventLoop::now() > deadline) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

std::optional<std::uint32_t> number_in(const std::string& digits, std::uint32_t count) {
  std::uint32_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc{} || stop != end || number >= count) return std::nullopt;
  return number;
}

std::uint32_t base(Sender sender) { return static_cast<std::uint32_t>(sender); }

}  // namespace

std::optional<OrderTarget> order_target(const std::string& words) {
  if (words == "all") return OrderTarget{};
  if (words == "vision") return OrderTarget{base(Sender::kVision), "sidestep-vision"};
  if (words == "simulator") return OrderTarget{base(Sender::kSimulator), "sidestep-simulator"};
  if (words == "coordinator" || words == "coordinator 0")
    return OrderTarget{base(Sender::kCoordinator), "sidestep-coordinator"};
  const auto space = words.find(' ');
  if (space == std::string::npos) return std::nullopt;
  const std::string kind = words.substr(0, space), digits = words.substr(space + 1);
  if (kind == "agent") {
    if (const auto robot = number_in(digits, kMaxRobots))
      return OrderTarget{*robot, fmt::format("agent-{}", *robot)};
  } else if (kind == "coordinator") {
    if (const auto number = number_in(digits, kMaxCoordinators))
      return OrderTarget{base(Sender::kCoordinator) + *number, fmt::format("coordinator-{}", *number)};
  }
  return std::nullopt;
}

void wait_for_taker(OperatorChannel& orders, const std::string& participant) {
  std::vector<std::string> takers;
  Time changed_at = EventLoop::now();
  const bool is_there = wait_until([&] {
    if (const auto now = orders.takers(); now != takers) {
      takers = now;
      changed_at = EventLoop::now();
    }
    if (participant.empty()) return !takers.empty() && EventLoop::now() - changed_at > kQuiet;
    return std::find(takers.begin(), takers.end(), participant) != takers.end();
  });
  if (is_there || (participant.empty() && !takers.empty())) return;
  throw std::runtime_error(
      fmt::format("{} takes such orders on this domain and interface{}",
                  participant.empty() ? "nobody" : "no " + participant,
                  takers.empty() ? "" : fmt::format(", only {}", fmt::join(takers, ", "))));
}

void wait_for_writer(OperatorChannel& orders, const std::string& channel, const std::string& complaint) {
  if (!wait_until([&] { return orders.is_written(channel); })) throw std::runtime_error(complaint);
}

void wait_until_taken(OperatorChannel& orders) {
  if (!orders.wait_until_taken(participant_lease() + kMissing)) {
    throw std::runtime_error(
        fmt::format("the order was sent, but not all of {} have taken it", fmt::join(orders.takers(), ", ")));
  }
}

msg::Header order_head() {
  msg::Header head;
  const Time now = EventLoop::now();
  head.sender(base(Sender::kOperator));
  head.incarnation(static_cast<std::uint64_t>(to_ns(now)));
  head.message_number(1);
  head.stamp_ns(to_ns(now));
  return head;
}

}  // namespace sidestep
