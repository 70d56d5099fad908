// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds_bus.hpp"

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDescription.hpp>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fmt/core.h>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "common/messaging/dds_participant.hpp"
#include "common/messaging/dds_types.hpp"
#include "common/messaging/event_loop.hpp"

namespace sidestep {
namespace {

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::ReaderDiscoveryInfo;
using eprosima::fastrtps::rtps::WriterDiscoveryInfo;

/// Reports strangers that use one of our topics with another type: DDS just never matches them.
class TypeWatch : public DomainParticipantListener {
 public:
  void expect(const std::string& channel, const std::string& type) {
    const std::lock_guard lock(mutex_);
    types_[channel] = type;
  }
  void on_publisher_discovery(DomainParticipant*, WriterDiscoveryInfo&& info) override {
    if (info.status == WriterDiscoveryInfo::DISCOVERED_WRITER) {
      compare("writer", info.info.topicName().to_string(), info.info.typeName().to_string());
    }
  }
  void on_subscriber_discovery(DomainParticipant*, ReaderDiscoveryInfo&& info) override {
    if (info.status == ReaderDiscoveryInfo::DISCOVERED_READER) {
      compare("reader", info.info.topicName().to_string(), info.info.typeName().to_string());
    }
  }

 private:
  void compare(const char* endpoint, const std::string& channel, const std::string& type) {
    const std::lock_guard lock(mutex_);
    const auto own = types_.find(channel);
    if (own == types_.end() || own->second == type) return;
    log_dds(fmt::format("topic '{}': a {} has type {} and is ignored, ours is {}", channel, endpoint, type,
                        own->second));
  }

  std::mutex mutex_;
  std::map<std::string, std::string> types_;
};

/// What the bus and its writers share, so that a writer may outlive the bus.
struct Session {
  explicit Session(const DdsSettings& settings) : participant(settings, &type_watch) {}

  TypeWatch type_watch;
  DdsParticipant participant;
};

class BusWriter : public RawWriter, public DataWriterListener {
 public:
  BusWriter(std::shared_ptr<Session> session, const TopicInfo& topic, const std::string& channel)
      : session_(std::move(session)),
        writer_(session_->participant.create_writer(channel, TypeSupport(make_dds_type(topic.type).release()),
                                                    dds_writer_qos(topic.qos), this)) {}
  ~BusWriter() override { session_->participant.delete_writer(writer_); }

  void write(const void* message) override {
    GuardedType::Sample sample{const_cast<void*>(message), true};
    if (!writer_->write(&sample)) report_failure();
  }
  void on_offered_incompatible_qos(DataWriter* writer, const OfferedIncompatibleQosStatus& status) override {
    log_dds(fmt::format("topic '{}': a reader asks for more than this writer offers, policy {}",
                        writer->get_topic()->get_name(), dds_policy_name(status.last_policy_id)));
  }

 private:
  void report_failure() {
    if (std::exchange(has_failed_, true)) return;
    log_dds(fmt::format("topic '{}': DDS refused to send a message", writer_->get_topic()->get_name()));
  }

  std::shared_ptr<Session> session_;
  DataWriter* writer_;
  bool has_failed_ = false;
};

class BusReader : public EventLoop::Source, public DataReaderListener {
 public:
  BusReader(EventLoop& loop, DdsParticipant& participant, const TopicInfo& topic, const std::string& channel,
            std::function<void(const void*)> callback)
      : loop_(loop),
        participant_(participant),
        channel_(channel),
        callback_(std::move(callback)),
        type_(make_dds_type(topic.type).release()),
        sample_(static_cast<GuardedType::Sample*>(type_.create_data())),
        reader_(participant.create_reader(channel, type_, dds_reader_qos(topic.qos), this)) {}
  ~BusReader() override {
    participant_.delete_reader(reader_);
    type_.delete_data(sample_);
  }

  bool drain() override {
    constexpr int kMostAtOnce = 64;
    SampleInfo info;
    for (int i = 0; i < kMostAtOnce && !loop_.stopped(); ++i) {
      if (reader_->take_next_sample(sample_, &info) != ReturnCode_t::RETCODE_OK) return false;
      if (!info.valid_data) continue;
      if (sample_->is_valid) {
        callback_(sample_->message);
      } else {
        count_refused();
      }
    }
    return true;
  }
  std::uint64_t refused() const { return refused_; }
  std::string locators() const { return dds_locators(*reader_); }

  void on_data_available(DataReader*) override { loop_.notify(*this); }
  void on_requested_incompatible_qos(DataReader*, const RequestedIncompatibleQosStatus& status) override {
    log_dds(fmt::format("topic '{}': a writer offers less than this reader asks for, policy {}", channel_,
                        dds_policy_name(status.last_policy_id)));
  }

 private:
  void count_refused() {
    if (++refused_ < next_report_) return;
    next_report_ *= 10;
    log_dds(fmt::format("topic '{}': {} unreadable message(s) refused so far", channel_, refused_));
  }

  EventLoop& loop_;
  DdsParticipant& participant_;
  std::string channel_;
  std::function<void(const void*)> callback_;
  TypeSupport type_;
  GuardedType::Sample* sample_;
  std::uint64_t refused_ = 0;
  std::uint64_t next_report_ = 1;
  DataReader* reader_;
};

}  // namespace

struct DdsBus::Impl {
  explicit Impl(const DdsSettings& settings) : session(std::make_shared<Session>(settings)) {}

  EventLoop loop;
  std::shared_ptr<Session> session;
  std::vector<std::unique_ptr<BusReader>> readers;
};

DdsBus::DdsBus(const DdsSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
DdsBus::~DdsBus() = default;

Time DdsBus::now() const { return EventLoop::now(); }
void DdsBus::at(Time when, std::function<void()> callback) { impl_->loop.at(when, std::move(callback)); }
void DdsBus::watch(int descriptor, std::function<void()> readable) {
  impl_->loop.watch(descriptor, std::move(readable));
}
void DdsBus::run() { impl_->loop.run_until(Time::max()); }
void DdsBus::run_until(Time when) { impl_->loop.run_until(when); }
void DdsBus::stop() { impl_->loop.stop(); }
std::string DdsBus::locators() const {
  return impl_->readers.empty() ? std::string() : impl_->readers.front()->locators();
}

void DdsBus::impair(const LinkQuality& quality, std::uint64_t seed) {
  impl_->session->participant.impair(quality, seed);
}

std::uint64_t DdsBus::refused() const {
  std::uint64_t sum = 0;
  for (const auto& reader : impl_->readers) sum += reader->refused();
  return sum;
}

std::unique_ptr<RawWriter> DdsBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  impl_->session->type_watch.expect(channel, topic.type.name);
  return std::make_unique<BusWriter>(impl_->session, topic, channel);
}

void DdsBus::make_reader(const TopicInfo& topic, const std::string& channel,
                         std::function<void(const void*)> callback) {
  impl_->session->type_watch.expect(channel, topic.type.name);
  impl_->readers.push_back(std::make_unique<BusReader>(impl_->loop, impl_->session->participant, topic,
                                                       channel, std::move(callback)));
}

}  // namespace sidestep
