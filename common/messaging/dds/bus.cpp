// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/bus.hpp"

#include <fmt/core.h>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/log/log.hpp"
#include "common/messaging/dds/endpoints.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/images.hpp"
#include "common/messaging/dds/type_mismatch_listener.hpp"
#include "common/messaging/topic_access.hpp"

namespace sidestep {

namespace {

struct Session {
  explicit Session(const DdsSettings& settings) : participant(settings, &type_mismatches) {}

  TypeMismatchListener type_mismatches;
  DdsParticipant participant;
};

}  // namespace

/// Writers share ownership of the participants, so writers may outlive the bus.
struct DdsBus::Impl {
  Impl(const DdsSettings& with, std::shared_ptr<EventLoop> runs)
      : loop(std::move(runs)), settings(with), session(std::make_shared<Session>(with)) {}

  std::shared_ptr<DdsParticipant> participant() { return {session, &session->participant}; }

  /// Faults are injected into UDP only, so a process with faults does not use shared memory.
  bool shares_memory(const TopicInfo& topic) const { return topic.qos == Qos::kImage && !settings.faults; }

  std::shared_ptr<EventLoop> loop;
  DdsSettings settings;
  std::shared_ptr<Session> session;
  std::shared_ptr<DdsParticipant> image_participant;  ///< null until images are published
  std::vector<std::unique_ptr<DdsReader>> readers;
  std::vector<std::unique_ptr<DdsImageReader>> image_readers;
};

DdsBus::DdsBus(const DdsSettings& settings)
    : DdsBus(std::make_unique<Impl>(settings, std::make_shared<EventLoop>())) {}
DdsBus::DdsBus(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DdsBus::~DdsBus() = default;

Time DdsBus::now() const { return EventLoop::now(); }
Time DdsBus::clock() { return EventLoop::now(); }
Duration DdsBus::host_clock_ahead() { return EventLoop::host_clock_ahead(); }
void DdsBus::adopt_host_clock() { EventLoop::adopt_host_clock(); }
void DdsBus::at(Time when, std::function<void()> callback) { impl_->loop->at(when, std::move(callback)); }
void DdsBus::watch(int descriptor, std::function<void()> readable) {
  impl_->loop->watch(descriptor, std::move(readable));
}
void DdsBus::post(std::function<void()> callback) { impl_->loop->post(std::move(callback)); }
void DdsBus::run() { impl_->loop->run_until(Time::max()); }
void DdsBus::run_until(Time when) { impl_->loop->run_until(when); }
void DdsBus::stop() { impl_->loop->stop(); }
std::unique_ptr<DdsBus> DdsBus::local_bus(int domain) const {
  if (domain == impl_->settings.domain)
    throw std::invalid_argument(
        fmt::format("DDS domain {} is already the domain of this process; expected a different one", domain));
  DdsSettings settings{domain, "127.0.0.1", impl_->settings.participant};
  settings.is_local_bus = true;
  return std::unique_ptr<DdsBus>(new DdsBus(std::make_unique<Impl>(settings, impl_->loop)));
}

std::string DdsBus::locators() const {
  return impl_->readers.empty() ? std::string() : impl_->readers.front()->locators();
}

void DdsBus::impair(const LinkQuality& quality, std::uint64_t seed) {
  impl_->session->participant.impair(quality, seed);
}

void DdsBus::add_drops(DropCounters& drops) const {
  std::uint64_t unreadable = 0;
  for (const auto& reader : impl_->readers) unreadable += reader->refused();
  for (const auto& reader : impl_->image_readers) unreadable += reader->reader().refused();
  drops.count(DropReason::kUnreadable, std::nullopt, unreadable);
  const TransportCounts& transport = impl_->session->participant.counts();
  drops.count(DropReason::kInjectedLoss, std::nullopt, transport.impaired);
  drops.count(DropReason::kQueueFull, std::nullopt, transport.overflowed);
  drops.count(DropReason::kMalformedDatagram, std::nullopt, transport.malformed);
  drops.count(DropReason::kForgottenPeer, std::nullopt, transport.forgotten);
  if (const ParticipantFilter* const filter = impl_->session->participant.filter()) {
    drops.count(DropReason::kUnknownParticipant, std::nullopt, filter->unknown());
    drops.count(DropReason::kRefusedParticipant, std::nullopt, filter->refused());
    drops.count(DropReason::kForgedSender, std::nullopt, filter->forged());
  }
}

bool DdsBus::has_keys() const { return impl_->session->participant.identity() != nullptr; }

bool DdsBus::meets_keys() const { return impl_->session->participant.meets_keys(); }

bool DdsBus::may_write(const TopicInfo& topic, std::uint32_t robot) const {
  const Identity* const identity = impl_->session->participant.identity();
  return !identity || sidestep::may_write(*identity, topic, robot);
}

bool DdsBus::may_read(const TopicInfo& topic, std::uint32_t robot) const {
  const Identity* const identity = impl_->session->participant.identity();
  return !identity || sidestep::may_read(*identity, topic, robot);
}

std::unique_ptr<RawWriter> DdsBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  impl_->session->type_mismatches.expect(channel, topic.type.name);
  if (!impl_->shares_memory(topic)) return std::make_unique<DdsWriter>(impl_->participant(), topic, channel);
  if (!impl_->image_participant) impl_->image_participant = image_publisher_participant(impl_->settings);
  return std::make_unique<DdsWriter>(impl_->image_participant, topic, channel);
}

void DdsBus::make_reader(const TopicInfo& topic, const std::string& channel,
                         std::function<void(const void*)> callback) {
  if (!may_read(topic, channel_robot(topic, channel).value_or(0))) {
    log(LogLevel::kDebug, fmt::format("no keys for reading the topic '{}'", channel));
    return;
  }
  impl_->session->type_mismatches.expect(channel, topic.type.name);
  if (impl_->shares_memory(topic)) {
    impl_->image_readers.push_back(std::make_unique<DdsImageReader>(
        *impl_->loop, impl_->settings, impl_->session->type_mismatches, topic, channel, std::move(callback)));
  } else {
    impl_->readers.push_back(
        std::make_unique<DdsReader>(*impl_->loop, impl_->participant(), topic, channel, std::move(callback)));
  }
}

}  // namespace sidestep
