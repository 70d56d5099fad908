// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "common/protocol/senders.hpp"
#include "deploy/audit/audited_robot.hpp"
#include "deploy/audit/order_audit.hpp"

namespace sidestep::order_memory_test {

inline constexpr auto kOperator = static_cast<std::uint32_t>(Sender::kOperator);
inline constexpr auto kReferee = static_cast<std::uint32_t>(Sender::kReferee);
inline constexpr auto kScenario = static_cast<std::uint32_t>(Sender::kScenario);
inline constexpr auto kFirst = static_cast<std::uint32_t>(Sender::kCoordinator), kSecond = kFirst + 1;
inline constexpr std::uint32_t kClient = 1'000'001, kOtherClient = 1'000'002;
inline constexpr std::size_t kMaxKept = 4096;

struct Found {
  AuditRule rule;
  RobotId robot;
  VersionNumber version;
  Epoch epoch;
  bool operator==(const Found&) const = default;
};

inline msg::RememberedOrder order(msg::OrderKind kind, std::uint32_t robot, std::uint32_t client,
                                  std::uint64_t number, std::uint32_t zone = 0) {
  msg::RememberedOrder order;
  order.robot(robot);
  order.client(client);
  order.terms().order_kind(kind);
  order.terms().order_number(number);
  order.terms().zone(zone);
  return order;
}
inline msg::RememberedOrder hold(std::uint32_t robot, std::uint64_t number, std::uint32_t client = kClient) {
  return order(msg::OrderKind::ORDER_HOLD, robot, client, number);
}
inline msg::RememberedOrder resume(std::uint32_t robot, std::uint64_t number,
                                   std::uint32_t client = kClient) {
  return order(msg::OrderKind::ORDER_RESUME, robot, client, number);
}

/// An audit of robots 3, 4 and 5 and two coordinators. Each call sends a message, 1 ms after the last call.
struct Run {
  explicit Run(bool is_complete = true)
      : audit({3, 4, 5}, is_complete, stamps,
              [this](AuditRule rule, RobotId robot, VersionNumber version, Epoch epoch,
                     const std::string& detail) {
                found.push_back({rule, robot, version, epoch});
                details.push_back(detail);
              }) {}

  msg::Header header(std::uint64_t channel, std::uint32_t sender) {
    now_ns += 1'000'000;
    msg::Header header;
    header.sender(sender);
    header.incarnation(incarnations[sender]);
    header.message_number(++sent[{channel, sender}]);
    header.stamp_ns(now_ns);
    stamps.record(channel, header);
    return header;
  }
  void send(const msg::RememberedOrder& sent_order) {
    msg::Order message;
    message.header().sender(sent_order.client());
    message.robot(sent_order.robot());
    message.terms(sent_order.terms());
    audit.on_order(message);
  }
  void answer(std::uint32_t coordinator, const msg::RememberedOrder& answered,
              msg::OrderResult result = msg::OrderResult::RESULT_REMEMBERED) {
    msg::OrderAnswer message;
    message.header(header(1, coordinator));
    message.client(answered.client());
    message.order_number(answered.terms().order_number());
    message.result(result);
    audit.on_answer(message);
  }
  void confirm(std::uint32_t coordinator, const msg::RememberedOrder& confirmed) {
    send(confirmed);
    answer(coordinator, confirmed);
  }
  msg::OrderMemory page(std::uint32_t process, const std::vector<msg::RememberedOrder>& orders,
                        std::uint32_t index = 0, std::uint32_t count = 1) {
    msg::OrderMemory memory;
    memory.header(header(2, process));
    memory.process(process);
    memory.page_index(index);
    memory.page_count(count);
    memory.is_complete(true);
    memory.order_count(static_cast<std::uint8_t>(orders.size()));
    std::copy(orders.begin(), orders.end(), memory.orders().begin());
    return memory;
  }
  /// A complete memory, on as many pages as necessary.
  void remember(std::uint32_t process, const std::vector<msg::RememberedOrder>& orders) {
    const std::size_t pages = std::max<std::size_t>(1, (orders.size() + 31) / 32);
    for (std::size_t i = 0; i < pages; ++i) {
      const auto from = orders.begin() + static_cast<std::ptrdiff_t>(std::min(32 * i, orders.size()));
      const auto to = orders.begin() + static_cast<std::ptrdiff_t>(std::min(32 * (i + 1), orders.size()));
      audit.on_memory(
          page(process, {from, to}, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(pages)));
    }
  }
  void grant(std::uint32_t coordinator, RobotId robot, VersionNumber version, Epoch epoch = 7,
             std::int64_t earliest_ns = kAlways) {
    msg::Verdict verdict;
    verdict.header(header(3, coordinator));
    verdict.robot(robot);
    verdict.epoch(epoch);
    verdict.granted_version(version);
    audit.on_grant(verdict, earliest_ns);
  }
  void status(RobotId robot, bool is_held, std::uint64_t number = 0, std::uint32_t client = 0) {
    msg::OrderStatus status;
    status.header(header(4, robot));
    status.robot(robot);
    status.is_held(is_held);
    status.order_number(number);
    status.client(client);
    audit.on_status(status);
  }
  void register_agent(RobotId robot, Epoch epoch) {
    msg::Registration registration;
    registration.header(header(5, robot));
    registration.robot(robot);
    registration.epoch(epoch);
    audit.on_registration(registration);
  }
  std::size_t count(AuditRule rule) const {
    return static_cast<std::size_t>(std::ranges::count(found, rule, &Found::rule));
  }

  std::int64_t now_ns = 1'000'000'000;
  std::map<std::uint32_t, Incarnation> incarnations{{kFirst, 10}, {kSecond, 20}, {3, 30},
                                                    {4, 40},      {5, 50},       {99, 60}};
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::uint64_t> sent;
  ComparableStamps stamps;
  std::vector<Found> found;
  std::vector<std::string> details;
  OrderAudit audit;
};

}  // namespace sidestep::order_memory_test
