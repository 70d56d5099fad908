// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds_listen.hpp"

#include <algorithm>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <map>
#include <mutex>
#include <sstream>
#include <tuple>
#include <utility>

#include "common/messaging/dds_participant.hpp"
#include "common/messaging/dds_types.hpp"
#include "common/messaging/event_loop.hpp"

namespace sidestep {
namespace {

using namespace eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

Duration to_duration(const eprosima::fastrtps::Duration_t& d) {
  return d == eprosima::fastrtps::c_TimeInfinite ? Duration::max() : Duration{d.to_ns()};
}

/// Works for WriterProxyData and ReaderProxyData.
template <typename Proxy>
DdsEndpoint to_endpoint(const Proxy& proxy, bool is_writer) {
  DdsEndpoint result;
  std::ostringstream guid;
  guid << proxy.guid();
  result.guid = guid.str();
  result.topic = proxy.topicName().to_string();
  result.type = proxy.typeName().to_string();
  result.is_writer = is_writer;
  result.is_keyed = proxy.topicKind() == rtps::WITH_KEY;
  result.is_reliable = proxy.m_qos.m_reliability.kind == RELIABLE_RELIABILITY_QOS;
  result.is_exclusive = proxy.m_qos.m_ownership.kind == EXCLUSIVE_OWNERSHIP_QOS;
  result.durability = static_cast<DdsEndpoint::Durability>(proxy.m_qos.m_durability.kind);
  result.liveliness = static_cast<DdsEndpoint::Liveliness>(proxy.m_qos.m_liveliness.kind);
  result.lease = to_duration(proxy.m_qos.m_liveliness.lease_duration);
  result.deadline = to_duration(proxy.m_qos.m_deadline.period);
  result.partitions = proxy.m_qos.m_partition.names();
  return result;
}

/// What the domain's participants have announced so far.
class Directory : public DomainParticipantListener {
 public:
  void on_participant_discovery(DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) override {
    const std::lock_guard lock(mutex_);
    if (info.status == rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT ||
        info.status == rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT) {
      names_[info.info.m_guid.guidPrefix] = info.info.m_participantName.to_string();
    }
  }
  void on_publisher_discovery(DomainParticipant*, rtps::WriterDiscoveryInfo&& info) override {
    update(info.info.guid(), info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER,
           to_endpoint(info.info, true));
  }
  void on_subscriber_discovery(DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) override {
    update(info.info.guid(), info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER,
           to_endpoint(info.info, false));
  }

  std::vector<DdsEndpoint> endpoints() const {
    const std::lock_guard lock(mutex_);
    std::vector<DdsEndpoint> result;
    for (const auto& [guid, endpoint] : endpoints_) {
      result.push_back(endpoint);
      const auto name = names_.find(guid.guidPrefix);
      if (name != names_.end()) result.back().participant = name->second;
    }
    std::sort(result.begin(), result.end(), [](const DdsEndpoint& a, const DdsEndpoint& b) {
      return std::tie(a.topic, b.is_writer, a.participant, a.guid) <
             std::tie(b.topic, a.is_writer, b.participant, b.guid);
    });
    return result;
  }

 private:
  void update(const rtps::GUID_t& guid, bool is_gone, DdsEndpoint&& endpoint) {
    const std::lock_guard lock(mutex_);
    if (is_gone) {
      endpoints_.erase(guid);
    } else {
      endpoints_[guid] = std::move(endpoint);
    }
  }

  mutable std::mutex mutex_;
  std::map<rtps::GuidPrefix_t, std::string> names_;
  std::map<rtps::GUID_t, DdsEndpoint> endpoints_;
};

/// Matches any writer of the topic, whatever it offers.
DataReaderQos undemanding_qos(const DdsEndpoint& writer) {
  constexpr int kDepth = 256;
  DataReaderQos qos = dds_reader_qos(Qos::kState);
  qos.history().depth = kDepth;
  qos.resource_limits().max_samples_per_instance = kDepth;
  qos.resource_limits().max_samples = qos.resource_limits().max_instances * kDepth;
  qos.ownership().kind = writer.is_exclusive ? EXCLUSIVE_OWNERSHIP_QOS : SHARED_OWNERSHIP_QOS;
  qos.type_consistency().representation.m_value = {XCDR_DATA_REPRESENTATION, XCDR2_DATA_REPRESENTATION};
  return qos;
}

class RawReader : public EventLoop::Source, public DataReaderListener {
 public:
  RawReader(EventLoop& loop, DdsParticipant& participant, const DdsEndpoint& writer,
            std::function<void(const RawSample&)> callback)
      : loop_(loop),
        participant_(participant),
        callback_(std::move(callback)),
        reader_(participant.create_reader(writer.topic,
                                          TypeSupport(new RawType(writer.type, writer.is_keyed)),
                                          undemanding_qos(writer), this)) {}
  ~RawReader() override { participant_.delete_reader(reader_); }

  bool drain() override {
    constexpr int kMostAtOnce = 256;
    SampleInfo info;
    for (int i = 0; i < kMostAtOnce && !loop_.stopped(); ++i) {
      if (reader_->take_next_sample(&bytes_, &info) != ReturnCode_t::RETCODE_OK) return false;
      if (info.valid_data) callback_({time_from_ns(info.reception_timestamp.to_ns()), bytes_});
    }
    return true;
  }
  void on_data_available(DataReader*) override { loop_.notify(*this); }

 private:
  EventLoop& loop_;
  DdsParticipant& participant_;
  std::function<void(const RawSample&)> callback_;
  std::vector<std::uint8_t> bytes_;
  DataReader* reader_;
};

}  // namespace

struct DdsListener::Impl {
  explicit Impl(const DdsSettings& settings) : participant(settings, &directory) {}

  EventLoop loop;
  Directory directory;
  DdsParticipant participant;
  std::vector<std::unique_ptr<RawReader>> readers;
};

DdsListener::DdsListener(const DdsSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
DdsListener::~DdsListener() = default;

std::vector<DdsEndpoint> DdsListener::endpoints() const { return impl_->directory.endpoints(); }

void DdsListener::listen(const DdsEndpoint& writer, std::function<void(const RawSample&)> callback) {
  impl_->readers.push_back(
      std::make_unique<RawReader>(impl_->loop, impl_->participant, writer, std::move(callback)));
}

Time DdsListener::now() const { return EventLoop::now(); }
void DdsListener::run_until(Time when) { impl_->loop.run_until(when); }
void DdsListener::stop() { impl_->loop.stop(); }
bool DdsListener::stopped() const { return impl_->loop.stopped(); }

}  // namespace sidestep
