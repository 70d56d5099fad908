// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/network.hpp"

#include <algorithm>

#include "common/messaging/sim/writer.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kReliableSeed = 0x9e3779b97f4a7c15;
// Measured over DDS, see README.md.
constexpr double kMinMatching_s = 0.03, kMaxMatching_s = 0.15;
constexpr double kMinRematching_s = 0.3, kMaxRematching_s = 1.6;

}  // namespace

SimNetwork::SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network)
    : rng_(seed), reliable_rng_(seed ^ kReliableSeed), begin_(begin), now_(begin), spec_(network) {}

bool SimNetwork::step(Time limit) {
  if (events_.is_empty() || events_.next_time() > limit) {
    now_ = std::max(now_, limit);
    return false;
  }
  now_ = events_.next_time();
  const Event event = events_.pop();
  constexpr std::size_t kPrefetchDistance = 4;
  if (const Event* coming = events_.peek(kPrefetchDistance)) __builtin_prefetch(coming->subscription);
  const SimProcessInstance& instance = *event.subscription->instance;
  if (!instance.is_alive) {
    drop(event);
  } else if (instance.paused_until > now_) {
    postpone(event);
  } else {
    run(event);
  }
  return true;
}

// Callbacks may add timers and messages, which moves the pools' elements. Therefore a timer is removed before
// it is called, and a message, which has its own allocation, is released after its delivery.
void SimNetwork::run(const Event& event) {
  if (event.is_timer) {
    timers_.remove(event.index)();
    return;
  }
  const void* message = sent_[event.index].message.get();
  delivering_ = event.index;
  event.subscription->callback(message);
  delivering_.reset();
  release(event.index);
}

void SimNetwork::drop(const Event& event) {
  if (event.is_timer)
    timers_.remove(event.index);
  else
    release(event.index);
}

void SimNetwork::release(std::uint32_t sent) {
  if (--sent_[sent].references == 0) sent_.remove(sent);
}

void SimNetwork::postpone(const Event& event) {
  SimProcessInstance& instance = *event.subscription->instance;
  if (instance.queued_until <= now_) {
    // The pause begins, or outlasts an earlier pause: all events due from now on follow in order.
    instance.queued_until = instance.paused_until;
    instance.queued = 0;
  }
  if (event.is_droppable && instance.queued++ >= instance.max_queued) {
    ++instance.overflowed;
    drop(event);
    return;
  }
  events_.push(instance.queued_until, event);
}

Duration SimNetwork::sample_delay(Rng& rng) const {
  const double span = to_seconds(spec_.delay_max - spec_.delay_min);
  return spec_.delay_min + from_seconds(rng.uniform() * std::max(0.0, span));
}

void SimNetwork::send(Writer& writer, const void* message) {
  const TopicInfo& topic = writer.topic();
  const ProcessId from = writer.instance().process;
  if (writer.channel().subscriptions.empty()) return;
  const std::uint32_t copy = sent_.add({topic.type.copy(message), 1});
  const bool is_hidden = !hidden_.empty() && hidden_.contains(from);
  for (SimSubscription* reader : writer.channel().subscriptions) {
    const ProcessId to = reader->instance->process;
    if (reader->instance->is_observer) {
      if (!is_hidden) deliver(*reader, now_, copy, false);
    } else if (topic.qos == Qos::kEvent) {
      send_event(writer, *reader, copy);
    } else if (links_.any() && links_.find(from, to)) {
      const MessageCopies copies = links_.send(from, to, rng_);
      for (std::size_t i = 0; i < copies.count; ++i) deliver(*reader, now_ + copies.delays[i], copy, true);
      reader->instance->lost += copies.count == 0;
    } else if (rng_.chance(spec_.loss)) {
      ++reader->instance->lost;
    } else {
      deliver(*reader, now_ + sample_delay(rng_), copy, true);
      if (rng_.chance(spec_.duplicate)) deliver(*reader, now_ + sample_delay(rng_), copy, true);
    }
  }
  release(copy);
}

void SimNetwork::send_event(Writer& writer, SimSubscription& reader, std::uint32_t sent) {
  const ProcessId from = writer.instance().process, to = reader.instance->process;
  // Always drawn, even if the message is lost, so that the delays of other messages do not depend on it.
  const Duration delay = event_delay(from, to, rng_);
  const std::shared_ptr<ReliableStream>& stream = writer.stream_to(reader, begin_, [&] {
    return ReliableStream::Delays{from_seconds(reliable_rng_.uniform(kMinMatching_s, kMaxMatching_s)),
                                  from_seconds(reliable_rng_.uniform(kMinRematching_s, kMaxRematching_s))};
  });
  if (!update_match(writer, *stream)) return;
  const bool has_arrived = arrives(from, to);
  if (stream->waiting().empty() && has_arrived)
    deliver_event(reader, delay, sent);
  else
    keep(writer, stream, sent, has_arrived);
}

void SimNetwork::keep(Writer& writer, const std::shared_ptr<ReliableStream>& stream, std::uint32_t sent,
                      bool has_arrived) {
  const auto key_of = writer.topic().type.cdr_key;
  const CdrKey key = key_of ? key_of(sent_[sent].message.get()) : CdrKey{};
  ++sent_[sent].references;
  stream->waiting().push_back({key, sent, has_arrived});
  if (const auto lost = stream->overwrite(key)) release(lost->sent);
  if (!stream->has_heartbeat) schedule_heartbeat(writer, stream);
}

void SimNetwork::schedule_heartbeat(Writer& writer, const std::shared_ptr<ReliableStream>& stream) {
  stream->has_heartbeat = true;
  const auto call = [this, alive = writer.alive(), stream] {
    Writer* const sender = *alive;
    if (!sender) return;
    stream->has_heartbeat = false;
    heartbeat(*sender, *stream);
    if (!stream->waiting().empty()) schedule_heartbeat(*sender, stream);
  };
  events_.push(now_ + kHeartbeatPeriod, {&writer.timers(), timers_.add(call), true, false});
}

void SimNetwork::heartbeat(Writer& writer, ReliableStream& stream) {
  const ProcessId from = writer.instance().process, to = stream.reader().instance->process;
  if (!update_match(writer, stream) || !arrives(from, to)) return;
  // The heartbeat tells the reader which messages are permanently lost, so the reader does not wait for them.
  deliver_arrived(stream, event_delay(from, to, reliable_rng_));
  if (stream.waiting().empty() || !arrives(to, from)) return;
  Duration delay{0};
  for (ReliableStream::Sample& sample : stream.waiting()) {
    if (sample.has_arrived) continue;
    sample.has_arrived = arrives(from, to);
    delay = std::max(delay, event_delay(from, to, reliable_rng_));
  }
  // The delays of a heartbeat, of the reader's answer, and of the resent messages.
  deliver_arrived(stream,
                  event_delay(from, to, reliable_rng_) + event_delay(to, from, reliable_rng_) + delay);
}

void SimNetwork::deliver_arrived(ReliableStream& stream, Duration delay) {
  std::vector<ReliableStream::Sample> arrived;
  while (const auto next = stream.pop_arrived()) arrived.push_back(*next);
  // Fast DDS passes waiting messages to a reader in this order.
  std::ranges::stable_sort(arrived, {}, &ReliableStream::Sample::key);
  for (const ReliableStream::Sample& sample : arrived) {
    deliver_event(stream.reader(), delay, sample.sent);
    release(sample.sent);
  }
}

bool SimNetwork::update_match(const Writer& writer, ReliableStream& stream) {
  SimProcessInstance &from = writer.instance(), &to = *stream.reader().instance;
  const Reachability reachability = both(both(reachability_of(from, now_), reachability_of(to, now_)),
                                         links_.reachability(from.process, to.process));
  const bool result = to.is_alive && stream.update(reachability, now_);
  if (!result) discard_waiting(stream);
  return result;
}

void SimNetwork::discard_waiting(ReliableStream& stream) {
  for (const ReliableStream::Sample& sample : stream.waiting()) release(sample.sent);
  stream.waiting().clear();
}

bool SimNetwork::arrives(ProcessId from, ProcessId to) {
  const LinkQuality* const link = links_.find(from, to);
  if (link && link->is_cut) return false;
  const double loss = link ? link->loss : spec_.loss;
  return loss <= 0 || !reliable_rng_.chance(loss);
}

Duration SimNetwork::event_delay(ProcessId from, ProcessId to, Rng& rng) {
  return links_.find(from, to) ? links_.delay(from, to, rng) : sample_delay(rng);
}

void SimNetwork::deliver_event(SimSubscription& reader, Duration delay, std::uint32_t sent) {
  reader.last_event = std::max(reader.last_event, now_ + delay);
  deliver(reader, reader.last_event, sent, false);
}

Reachability& SimNetwork::reachability_of(SimProcessInstance& instance, Time now) {
  if (instance.paused_until <= now && instance.reachability.silent_from < instance.paused_until)
    instance.reachability.on_silence_end(instance.paused_until);
  return instance.reachability;
}

void SimNetwork::deliver(SimSubscription& reader, Time when, std::uint32_t sent, bool is_droppable) {
  ++sent_[sent].references;
  events_.push(when, {&reader, sent, false, is_droppable});
}

}  // namespace sidestep
