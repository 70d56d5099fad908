// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/bus.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/sim/writer.hpp"

namespace sidestep {

SimBus::SimBus(SimNetwork& network) : SimBus(network, {network.new_process()}) {}

SimBus::SimBus(SimNetwork& network, const SimProcessSpec& spec)
    : network_(network),
      clock_(spec.clock),
      instance_(&network.instances_.emplace_back()),
      timers_(&network.subscriptions_.emplace_back(SimSubscription{instance_, nullptr})) {
  instance_->process = spec.process;
}

SimBus::~SimBus() {
  instance_->is_alive = false;
  for (auto& [name, channel] : network_.channels_) {
    std::erase_if(channel->subscriptions, [&](const auto* reader) { return reader->instance == instance_; });
  }
}

Time SimBus::now() const { return clock_.reading(network_.now()); }

void SimBus::at(Time when, std::function<void()> callback) {
  network_.events_.push(std::max(clock_.true_time(when), network_.now()),
                        {timers_, network_.timers_.add(std::move(callback)), true, false});
}

MessageAttachment* SimBus::attachment(const void* message) {
  if (!network_.delivering_) return nullptr;
  SimNetwork::SentMessage& sent = network_.sent_[*network_.delivering_];
  return sent.message.get() == message ? &sent.attachment : nullptr;
}

void SimBus::become_observer() { instance_->is_observer = true; }

void SimBus::hide_from_observers() { network_.hidden_.insert(instance_->process); }

void SimBus::pause(Time until, std::size_t max_queued) {
  SimProcessInstance& instance = *instance_;
  const bool is_paused = instance.paused_until > network_.now();
  SimNetwork::reachability_of(instance, network_.now()).silence(network_.now());
  instance.paused_until = is_paused ? std::max(instance.paused_until, until) : until;
  if (!is_paused) instance.queued = 0;
  instance.max_queued = max_queued;
}

SimNetwork::Channel& SimBus::channel_named(const std::string& name) {
  auto& slot = network_.channels_[name];
  if (!slot) slot = std::make_unique<SimNetwork::Channel>();
  return *slot;
}

std::unique_ptr<RawWriter> SimBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  return std::make_unique<SimNetwork::Writer>(network_, *timers_, topic, channel_named(channel));
}

void SimBus::add_drops(DropCounters& drops) const {
  drops.count(DropReason::kInjectedLoss, std::nullopt, instance_->lost);
  drops.count(DropReason::kQueueFull, std::nullopt, instance_->overflowed);
}

void SimBus::make_reader(const TopicInfo&, const std::string& channel,
                         std::function<void(const void*)> callback) {
  channel_named(channel).subscriptions.push_back(
      &network_.subscriptions_.emplace_back(SimSubscription{instance_, std::move(callback), network_.now()}));
}

}  // namespace sidestep
