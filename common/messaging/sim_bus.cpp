// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim_bus.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

class SimNetwork::Writer : public RawWriter {
 public:
  Writer(SimNetwork& network, const TopicInfo& topic, Channel& channel)
      : network_(network), topic_(topic), channel_(channel) {}
  void write(const void* message) override { network_.send(topic_, channel_, message); }

 private:
  SimNetwork& network_;
  TopicInfo topic_;
  Channel& channel_;
};

SimBus::SimBus(SimNetwork& network) : network_(network), alive_(std::make_shared<bool>(true)) {}

SimBus::~SimBus() {
  *alive_ = false;
  for (auto& [name, channel] : network_.channels_) {
    std::erase_if(channel->readers, [&](const auto& reader) { return reader->alive == alive_; });
  }
}

Time SimBus::now() const { return network_.now(); }

void SimBus::at(Time when, std::function<void()> callback) {
  network_.schedule(std::max(when, network_.now()), alive_, std::move(callback));
}

std::unique_ptr<RawWriter> SimBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  auto& slot = network_.channels_[channel];
  if (!slot) slot = std::make_unique<SimNetwork::Channel>();
  return std::make_unique<SimNetwork::Writer>(network_, topic, *slot);
}

void SimBus::make_reader(const TopicInfo&, const std::string& channel,
                         std::function<void(const void*)> callback) {
  auto& slot = network_.channels_[channel];
  if (!slot) slot = std::make_unique<SimNetwork::Channel>();
  slot->readers.push_back(
      std::make_shared<SimNetwork::Reader>(SimNetwork::Reader{alive_, std::move(callback), Time{}}));
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
  if (*event.alive) event.run();
  return true;
}

void SimNetwork::schedule(Time when, const std::shared_ptr<bool>& alive, std::function<void()> run) {
  events_.push({when, order_++, alive, std::move(run)});
}

Duration SimNetwork::draw_delay() {
  const double span = to_seconds(spec_.delay_max - spec_.delay_min);
  return spec_.delay_min + from_seconds(rng_.uniform() * std::max(0.0, span));
}

void SimNetwork::send(const TopicInfo& topic, Channel& channel, const void* message) {
  if (channel.readers.empty()) return;
  const std::shared_ptr<const void> copy = topic.type.copy(message);
  for (const auto& reader : channel.readers) {
    if (topic.qos == Qos::kEvent) {
      reader->last_event = std::max(reader->last_event, now_ + draw_delay());
      deliver(reader, reader->last_event, copy);
      continue;
    }
    if (rng_.chance(spec_.loss)) continue;
    deliver(reader, now_ + draw_delay(), copy);
    if (rng_.chance(spec_.duplicate)) deliver(reader, now_ + draw_delay(), copy);
  }
}

void SimNetwork::deliver(const std::shared_ptr<Reader>& reader, Time when,
                         const std::shared_ptr<const void>& message) {
  schedule(when, reader->alive, [reader, message] { reader->callback(message.get()); });
}

}  // namespace sidestep
