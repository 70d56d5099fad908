// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/sim_bus.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

class SimNetwork::Writer : public RawWriter {
 public:
  Writer(SimNetwork& network, ProcessId from, const TopicInfo& topic, Channel& channel)
      : network_(network), from_(from), topic_(topic), channel_(channel) {}
  void write(const void* message) override { network_.send(from_, topic_, channel_, message); }

 private:
  SimNetwork& network_;
  ProcessId from_;
  TopicInfo topic_;
  Channel& channel_;
};

SimBus::SimBus(SimNetwork& network) : SimBus(network, {network.new_process()}) {}

SimBus::SimBus(SimNetwork& network, const SimPlace& place)
    : network_(network),
      clock_offset_(place.clock_offset),
      life_(&network.lives_.emplace_back()),
      timers_(&network.readers_.emplace_back(SimReader{life_, nullptr})) {
  life_->process = place.process;
}

SimBus::~SimBus() {
  life_->is_alive = false;
  for (auto& [name, channel] : network_.channels_) {
    std::erase_if(channel->readers, [&](const auto* reader) { return reader->life == life_; });
  }
}

Time SimBus::now() const { return network_.now() + clock_offset_; }

void SimBus::at(Time when, std::function<void()> callback) {
  network_.events_.put(std::max(when - clock_offset_, network_.now()),
                       {timers_, network_.timers_.put(std::move(callback)), true, false});
}

std::shared_ptr<void>* SimBus::beside(const void* message) {
  if (!network_.delivering_) return nullptr;
  SimNetwork::Sent& sent = network_.sent_[*network_.delivering_];
  return sent.message.get() == message ? &sent.beside : nullptr;
}

void SimBus::listen_aside() { life_->is_aside = true; }

void SimBus::pause(Time until, std::size_t most_waiting) {
  life_->paused_until = until;
  life_->waiting = 0;
  life_->most_waiting = most_waiting;
}

std::unique_ptr<RawWriter> SimBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  auto& slot = network_.channels_[channel];
  if (!slot) slot = std::make_unique<SimNetwork::Channel>();
  return std::make_unique<SimNetwork::Writer>(network_, life_->process, topic, *slot);
}

void SimBus::make_reader(const TopicInfo&, const std::string& channel,
                         std::function<void(const void*)> callback) {
  auto& slot = network_.channels_[channel];
  if (!slot) slot = std::make_unique<SimNetwork::Channel>();
  slot->readers.push_back(&network_.readers_.emplace_back(SimReader{life_, std::move(callback)}));
}

SimNetwork::SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network)
    : rng_(seed), now_(begin), spec_(network) {}

bool SimNetwork::step(Time limit) {
  if (events_.is_empty() || events_.next_time() > limit) {
    now_ = std::max(now_, limit);
    return false;
  }
  now_ = events_.next_time();
  const Event event = events_.take();
  constexpr std::size_t kFetchAhead = 4;
  if (const Event* coming = events_.ahead(kFetchAhead)) __builtin_prefetch(coming->reader);
  const SimLife& life = *event.reader->life;
  if (!life.is_alive) {
    drop(event);
  } else if (life.paused_until > now_) {
    hold_back(event);
  } else {
    run(event);
  }
  return true;
}

// A timer is taken out first, and a message stays where it is, because what runs puts others in.
void SimNetwork::run(const Event& event) {
  if (event.is_timer) {
    timers_.take(event.content)();
    return;
  }
  const void* message = sent_[event.content].message.get();
  delivering_ = event.content;
  event.reader->callback(message);
  delivering_.reset();
  release(event.content);
}

void SimNetwork::drop(const Event& event) {
  if (event.is_timer)
    timers_.take(event.content);
  else
    release(event.content);
}

void SimNetwork::release(std::uint32_t sent) {
  if (--sent_[sent].under_way == 0) sent_.take(sent);
}

void SimNetwork::hold_back(const Event& event) {
  SimLife& life = *event.reader->life;
  if (event.may_be_lost && life.waiting++ >= life.most_waiting) {
    drop(event);
    return;
  }
  events_.put(life.paused_until, event);
}

Duration SimNetwork::sample_delay() {
  const double span = to_seconds(spec_.delay_max - spec_.delay_min);
  return spec_.delay_min + from_seconds(rng_.uniform() * std::max(0.0, span));
}

void SimNetwork::send(ProcessId from, const TopicInfo& topic, Channel& channel, const void* message) {
  if (channel.readers.empty()) return;
  const std::uint32_t copy = sent_.put({topic.type.copy(message), 1});
  for (Reader* reader : channel.readers) {
    const ProcessId to = reader->life->process;
    if (reader->life->is_aside) {
      deliver(*reader, now_, copy, false);
    } else if (topic.qos == Qos::kEvent) {
      send_event(from, *reader, copy);
    } else if (links_.any() && links_.find(from, to)) {
      const Copies copies = links_.send(from, to, rng_);
      for (std::size_t i = 0; i < copies.count; ++i) deliver(*reader, now_ + copies.delays[i], copy, true);
    } else if (!rng_.chance(spec_.loss)) {
      deliver(*reader, now_ + sample_delay(), copy, true);
      if (rng_.chance(spec_.duplicate)) deliver(*reader, now_ + sample_delay(), copy, true);
    }
  }
  release(copy);
}

void SimNetwork::send_event(ProcessId from, Reader& reader, std::uint32_t sent) {
  const ProcessId to = reader.life->process;
  const Duration delay = links_.find(from, to) ? links_.delay(from, to, rng_) : sample_delay();
  reader.last_event = std::max(reader.last_event, now_ + delay);
  deliver(reader, reader.last_event, sent, false);
}

void SimNetwork::deliver(Reader& reader, Time when, std::uint32_t sent, bool may_be_lost) {
  ++sent_[sent].under_way;
  events_.put(when, {&reader, sent, false, may_be_lost});
}

}  // namespace sidestep
