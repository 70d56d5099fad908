// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/audit/thinning.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace sidestep {
namespace {

constexpr std::size_t kTopics = std::variant_size_v<AuditedMessage>;

const msg::Header& header_of(const AuditedMessage& message) {
  return std::visit([](const auto& m) -> const msg::Header& { return m.header(); }, message);
}

/// The losses of one stream of messages: independent, or in bursts (Gilbert 1960).
class Stream {
 public:
  Stream(double loss, double mean_burst, Rng rng) : loss_(loss), mean_burst_(mean_burst), rng_(rng) {}

  bool loses_next() {
    if (mean_burst_ <= 1 || loss_ >= 1) return rng_.chance(loss_);
    const double to_good = 1 / mean_burst_, to_bad = to_good * loss_ / (1 - loss_);
    is_bad_ = is_bad_ ? !rng_.chance(to_good) : rng_.chance(std::min(1.0, to_bad));
    return is_bad_;
  }

 private:
  double loss_, mean_burst_;
  Rng rng_;
  bool is_bad_ = false;
};

class Thinning {
 public:
  Thinning(const MessageHistory& history, std::uint64_t seed) : rng_(seed) {
    loss_.fill(rng_.uniform(0.01, 0.7));
    result_.losses = fmt::format("{:.0f} %", 100 * loss_.front());
    if (rng_.chance(0.4)) lose_by_topic();
    if (rng_.chance(0.4)) {
      mean_burst_ = rng_.uniform(2, 60);
      result_.losses += fmt::format(", bursts of {:.0f}", mean_burst_);
    }
    is_by_sender_ = rng_.chance(0.3);
    if (is_by_sender_) result_.losses += ", by sender";
    const Duration length = history.messages.back().at - history.messages.front().at;
    begin_ = history.messages.front().at;
    if (rng_.chance(0.3)) {
      begin_ += from_seconds(rng_.uniform() * 0.8 * to_seconds(length));
      result_.losses += fmt::format(", from {:.1f} s on", to_seconds(begin_ - history.messages.front().at));
    }
    if (rng_.chance(0.3)) add_outages(length);
    if (rng_.chance(0.5)) delay();
  }

  DegradedHistory of(const MessageHistory& history) && {
    for (const ReceivedMessage& received : history.messages) {
      if (is_lost(received)) continue;
      const double delay_s = delay_s_[received.message.index()] + jitter_s_ * rng_.uniform();
      result_.deliveries.push_back({received.at + from_seconds(delay_s), &received.message});
    }
    std::ranges::stable_sort(result_.deliveries, {}, &Delivery::at);
    return std::move(result_);
  }

 private:
  void lose_by_topic() {
    for (double& loss : loss_) {
      const double u = rng_.uniform();
      loss = u < 0.3 ? 0 : u < 0.4 ? 1 : rng_.uniform(0.01, 0.7);
    }
    result_.losses = "by topic:";
    for (const double loss : loss_) result_.losses += fmt::format(" {:.0f}", 100 * loss);
    result_.losses += " %";
  }

  void add_outages(Duration length) {
    for (std::uint64_t left = 1 + rng_.below(3); left > 0; --left) {
      const Time from = begin_ + from_seconds(rng_.uniform() * to_seconds(length));
      outages_.emplace_back(from, from + from_seconds(rng_.uniform(0.2, 3)));
    }
    result_.losses += fmt::format(", {} outages", outages_.size());
  }

  /// Simulates an overloaded receiver: some topics are always delayed in queues.
  void delay() {
    jitter_s_ = rng_.chance(0.5) ? 0.02 : 0.001;
    for (double& delay_s : delay_s_) delay_s = rng_.chance(0.3) ? rng_.uniform(0, 0.2) : 0;
    result_.losses += ", delays of";
    for (const double delay_s : delay_s_) result_.losses += fmt::format(" {:.0f}", 1000 * delay_s);
    result_.losses += " ms";
  }

  bool is_lost(const ReceivedMessage& received) {
    const std::size_t topic = received.message.index();
    const bool has_truth = loss_[index_of<msg::GroundTruth>()] < 0.2 && outages_.empty() && mean_burst_ <= 1;
    if (topic == index_of<msg::Disturbance>() && !has_truth) return false;
    if (received.at < begin_) return true;
    for (const auto& [from, until] : outages_) {
      if (received.at >= from && received.at < until) return true;
    }
    const std::uint64_t sender = is_by_sender_ ? header_of(received.message).sender() : 0;
    auto stream = streams_.find({topic, sender});
    if (stream == streams_.end()) {
      const double loss = is_by_sender_ ? rng_.uniform(0, 0.7) : loss_[topic];
      stream = streams_.emplace(std::pair(topic, sender), Stream(loss, mean_burst_, rng_.fork())).first;
    }
    return stream->second.loses_next();
  }

  template <typename Message>
  static constexpr std::size_t index_of() {
    std::size_t index = 0;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((std::is_same_v<std::variant_alternative_t<I, AuditedMessage>, Message> ? void(index = I) : void()),
       ...);
    }
    (std::make_index_sequence<kTopics>());
    return index;
  }

  Rng rng_;
  std::array<double, kTopics> loss_{}, delay_s_{};
  double mean_burst_ = 1, jitter_s_ = 0;
  bool is_by_sender_ = false;
  Time begin_{};
  std::vector<std::pair<Time, Time>> outages_;
  std::map<std::pair<std::size_t, std::uint64_t>, Stream> streams_;
  DegradedHistory result_;
};

}  // namespace

DegradedHistory thinned(const MessageHistory& history, std::uint64_t seed) {
  return Thinning(history, seed).of(history);
}

}  // namespace sidestep
