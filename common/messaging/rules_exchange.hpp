// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/config/shared_rules.hpp"
#include "common/messaging/bus.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// A process whose rules differ from ours.
struct RulesMismatch {
  std::uint32_t process = 0;                ///< the process's id, see senders.hpp
  std::vector<RuleDifference> differences;  ///< empty: that process has not sent its rules yet
};

/// Makes a process refuse all messages from processes with different rules (PROTOCOL.md, "The same rules"),
/// and sends them its own rules, so that both sides can name the differences.
class RulesExchange {
 public:
  /// After the first refusal, the rules are sent at most once per kPeriod.
  static constexpr Duration kPeriod{500'000'000};
  using OnMismatch = std::function<void(const RulesMismatch&)>;

  /// `process` is this process's id. For each process and its rules, `on_mismatch` is called once without and
  /// once with the differences. Create it before the nodes of the process.
  RulesExchange(Bus& bus, std::uint32_t process, const SharedRules& rules, OnMismatch on_mismatch);
  RulesExchange(const RulesExchange&) = delete;
  RulesExchange& operator=(const RulesExchange&) = delete;

 private:
  using Fingerprint = SharedRules::Fingerprint;
  void on_refused(const TopicInfo& topic, const msg::Header& header);
  void on_rules(const msg::SharedRules& message);
  void report(std::uint32_t process, Fingerprint fingerprint, std::vector<RuleDifference> differences);
  void publish_if_due();

  Bus& bus_;
  const std::uint32_t process_;
  const SharedRules rules_;
  const OnMismatch on_mismatch_;
  std::optional<Writer<msg::SharedRules>> writer_;  ///< nullopt until a message is refused
  std::optional<Time> published_at_;
  /// Indexed by process and fingerprint: whether the differences have been reported.
  std::map<std::pair<std::uint32_t, Fingerprint>, bool> reported_;
  RateLimit later_reports_{1, std::chrono::seconds(10)};  ///< used once reported_ is full
};

/// A log message such as "refuses agent 3, which has different rules: margin_m is 0.02 instead of 0.01".
std::string describe(const RulesMismatch& mismatch);

}  // namespace sidestep
