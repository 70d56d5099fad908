// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/rules_exchange.hpp"

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

// Bounded, because a hostile sender may invent any number of processes and rules.
constexpr std::size_t kMaxReported = 256;

}  // namespace

RulesExchange::RulesExchange(Bus& bus, std::uint32_t process, const SharedRules& rules,
                             OnMismatch on_mismatch)
    : bus_(bus), process_(process), rules_(rules), on_mismatch_(std::move(on_mismatch)) {
  bus_.use_rules(rules_.fingerprint(),
                 [this](const TopicInfo& topic, const msg::Header& header) { on_refused(topic, header); });
  bus_.subscribe(topics::kRules, [this](const msg::SharedRules& message) { on_rules(message); });
}

void RulesExchange::on_refused(const TopicInfo& topic, const msg::Header& header) {
  // The simulator sends the messages of its robots with the robots' numbers as senders.
  const bool is_simulator = topic.per_robot && topic.writers.has(Role::kSimulator);
  report(is_simulator ? static_cast<std::uint32_t>(Sender::kSimulator) : header.sender(), header.rules(), {});
  publish_if_due();
}

void RulesExchange::on_rules(const msg::SharedRules& message) {
  const auto others =
      SharedRules::parse({reinterpret_cast<const char*>(message.text().data()), message.text().size()});
  if (!others) bus_.count_drop(DropReason::kMalformedRules);
  if (!others || others->fingerprint() == rules_.fingerprint()) return;
  report(message.process(), others->fingerprint(), rules_.differences(*others));
  publish_if_due();
}

void RulesExchange::report(std::uint32_t process, Fingerprint fingerprint,
                           std::vector<RuleDifference> differences) {
  const std::pair key(process, fingerprint);
  const bool is_full = reported_.size() >= kMaxReported && !reported_.contains(key);
  // A hostile sender can invent processes. Once the table is full, later processes are still reported, but
  // rarely.
  if (is_full && !later_reports_.admit(bus_.now())) return;
  if (is_full) reported_.erase(reported_.begin());
  const auto [known, is_new] = reported_.try_emplace(key, false);
  if (!is_new && (known->second || differences.empty())) return;
  known->second = !differences.empty();
  on_mismatch_({process, std::move(differences)});
}

void RulesExchange::publish_if_due() {
  const Time now = bus_.now();
  if (!bus_.may_write(topics::kRules, 0)) return;
  if (published_at_ && now - *published_at_ < kPeriod) return;
  published_at_ = now;
  msg::SharedRules message;
  message.process(process_);
  message.header().sender(process_);
  message.text().assign(rules_.text().begin(), rules_.text().end());
  // Created only on demand: with many processes, unnecessary writers would dominate the start-up time.
  if (!writer_) {
    writer_ = bus_.advertise(topics::kRules);
    // Over DDS the first message is lost, because no process has discovered this writer yet. The other
    // process might never send another message that is refused, so the rules are sent again later.
    for (const int periods : {1, 2, 4}) bus_.at(now + periods * kPeriod, [this] { publish_if_due(); });
  }
  writer_->publish(message, now);
}

std::string describe(const RulesMismatch& mismatch) {
  std::string text = "refuses " + process_name(mismatch.process) + ", which has different rules";
  if (!mismatch.differences.empty()) text += ": " + describe(mismatch.differences);
  return text;
}

}  // namespace sidestep
