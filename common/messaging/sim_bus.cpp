// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim_bus.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

/// What the network has to know of one life of a process.
struct SimLife {
  ProcessId process;
  bool is_alive = true;
  bool is_aside = false;
  Time paused_until = Time::min();
  std::size_t waiting = 0, most_waiting = 0;
};

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
      life_(std::make_shared<SimLife>(SimLife{place.process})) {}

SimBus::~SimBus() {
  life_->is_alive = false;
  for (auto& [name, channel] : network_.channels_) {
    std::erase_if(channel->readers, [&](const auto& reader) { return reader->life == life_; });
  }
}

Time SimBus::now() const { return network_.now() + clock_offset_; }

void SimBus::at(Time when, std::function<void()> callback) {
  network_.schedule(std::max(when - clock_offset_, network_.now()), life_, std::move(callback));
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
  slot->readers.push_back(
      std::make_shared<SimNetwork::Reader>(SimNetwork::Reader{life_, std::move(callback), Time{}}));
}

SimNetwork::SimNetwork(std::uint64_t seed, Time begin, const NetworkSpec& network)
    : rng_(seed), now_(begin), spec_(network) {}

bool SimNetwork::step(Time limit) {
  if (events_.empty() || events_.top().when > limit) {
    now_ = std::max(now_, limit);
    return false;
  }
  // The queue is left consistent before the event runs, because the event schedules others.
  Event event = std::move(const_cast<Event&>(events_.top()));
  events_.pop();
  now_ = event.when;
  if (!event.life->is_alive) return true;
  if (event.life->paused_until > now_) {
    hold_back(std::move(event));
    return true;
  }
  event.run();
  return true;
}

void SimNetwork::hold_back(Event event) {
  SimLife& life = *event.life;
  if (event.may_be_lost && life.waiting++ >= life.most_waiting) return;
  event.when = life.paused_until;
  event.order = order_++;
  events_.push(std::move(event));
}

void SimNetwork::schedule(Time when, const std::shared_ptr<SimLife>& life, std::function<void()> run,
                          bool may_be_lost) {
  events_.push({when, order_++, life, std::move(run), may_be_lost});
}

Duration SimNetwork::draw_delay() {
  const double span = to_seconds(spec_.delay_max - spec_.delay_min);
  return spec_.delay_min + from_seconds(rng_.uniform() * std::max(0.0, span));
}

void SimNetwork::send(ProcessId from, const TopicInfo& topic, Channel& channel, const void* message) {
  if (channel.readers.empty()) return;
  const std::shared_ptr<const void> copy = topic.type.copy(message);
  for (const auto& reader : channel.readers) {
    const ProcessId to = reader->life->process;
    if (reader->life->is_aside) {
      deliver(reader, now_, copy, false);
    } else if (topic.qos == Qos::kEvent) {
      send_event(from, reader, copy);
    } else if (links_.any() && links_.find(from, to)) {
      const Copies copies = links_.send(from, to, rng_);
      for (std::size_t i = 0; i < copies.count; ++i) deliver(reader, now_ + copies.delays[i], copy, true);
    } else if (!rng_.chance(spec_.loss)) {
      deliver(reader, now_ + draw_delay(), copy, true);
      if (rng_.chance(spec_.duplicate)) deliver(reader, now_ + draw_delay(), copy, true);
    }
  }
}

void SimNetwork::send_event(ProcessId from, const std::shared_ptr<Reader>& reader,
                            const std::shared_ptr<const void>& message) {
  const ProcessId to = reader->life->process;
  const Duration delay = links_.find(from, to) ? links_.delay(from, to, rng_) : draw_delay();
  reader->last_event = std::max(reader->last_event, now_ + delay);
  deliver(reader, reader->last_event, message, false);
}

void SimNetwork::deliver(const std::shared_ptr<Reader>& reader, Time when,
                         const std::shared_ptr<const void>& message, bool may_be_lost) {
  schedule(
      when, reader->life, [reader, message] { reader->callback(message.get()); }, may_be_lost);
}

}  // namespace sidestep
