// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/network.hpp"

#include <algorithm>

namespace sidestep {

SimNetwork::SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network)
    : rng_(seed), now_(begin), spec_(network) {}

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

// A callback may add timers and messages, and so move the pools' elements: a timer is therefore removed
// before it is called, and a message, which has its own allocation, is released after its delivery.
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
    // The pause begins, or goes on after the first of two: all events that are due now follow in their order.
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

Duration SimNetwork::sample_delay() {
  const double span = to_seconds(spec_.delay_max - spec_.delay_min);
  return spec_.delay_min + from_seconds(rng_.uniform() * std::max(0.0, span));
}

void SimNetwork::send(ProcessId from, const TopicInfo& topic, Channel& channel, const void* message) {
  if (channel.subscriptions.empty()) return;
  const std::uint32_t copy = sent_.add({topic.type.copy(message), 1});
  const bool is_hidden = !hidden_.empty() && hidden_.contains(from);
  for (SimSubscription* reader : channel.subscriptions) {
    const ProcessId to = reader->instance->process;
    if (reader->instance->is_observer) {
      if (!is_hidden) deliver(*reader, now_, copy, false);
    } else if (topic.qos == Qos::kEvent) {
      send_event(from, *reader, copy);
    } else if (links_.any() && links_.find(from, to)) {
      const MessageCopies copies = links_.send(from, to, rng_);
      for (std::size_t i = 0; i < copies.count; ++i) deliver(*reader, now_ + copies.delays[i], copy, true);
      reader->instance->lost += copies.count == 0;
    } else if (rng_.chance(spec_.loss)) {
      ++reader->instance->lost;
    } else {
      deliver(*reader, now_ + sample_delay(), copy, true);
      if (rng_.chance(spec_.duplicate)) deliver(*reader, now_ + sample_delay(), copy, true);
    }
  }
  release(copy);
}

void SimNetwork::send_event(ProcessId from, SimSubscription& reader, std::uint32_t sent) {
  const ProcessId to = reader.instance->process;
  const Duration delay = links_.find(from, to) ? links_.delay(from, to, rng_) : sample_delay();
  reader.last_event = std::max(reader.last_event, now_ + delay);
  deliver(reader, reader.last_event, sent, false);
}

void SimNetwork::deliver(SimSubscription& reader, Time when, std::uint32_t sent, bool is_droppable) {
  ++sent_[sent].references;
  events_.push(when, {&reader, sent, false, is_droppable});
}

}  // namespace sidestep
