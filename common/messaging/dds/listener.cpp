// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/listener.hpp"

#include <utility>

#include "common/messaging/dds/directory.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"

namespace sidestep {
namespace {

using namespace fast_dds::dds;

/// A QoS that matches every writer of the topic.
DataReaderQos permissive_qos(const DiscoveredEndpoint& writer) {
  constexpr int kDepth = 256;
  DataReaderQos qos = dds_reader_qos(Qos::kState, kDepth);
  qos.ownership().kind = writer.is_exclusive ? EXCLUSIVE_OWNERSHIP_QOS : SHARED_OWNERSHIP_QOS;
  fast_dds::representation(qos).m_value = {XCDR_DATA_REPRESENTATION, XCDR2_DATA_REPRESENTATION};
  return qos;
}

class RawReader : public EventLoop::Source, public DataReaderListener {
 public:
  RawReader(EventLoop& loop, DdsParticipant& participant, const DiscoveredEndpoint& writer,
            std::function<void(const RawSample&)> callback)
      : loop_(loop),
        participant_(participant),
        callback_(std::move(callback)),
        reader_(participant.create_reader(writer.topic,
                                          TypeSupport(new RawType(writer.type, writer.is_keyed)),
                                          permissive_qos(writer), this)) {}
  ~RawReader() override { participant_.delete_reader(reader_); }

  bool drain() override {
    constexpr int kMaxBatch = 256;
    SampleInfo info;
    for (int i = 0; i < kMaxBatch && !loop_.stopped(); ++i) {
      if (!fast_dds::is_ok(reader_->take_next_sample(&bytes_, &info))) return false;
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
  DdsDirectory directory;
  DdsParticipant participant;
  std::vector<std::unique_ptr<RawReader>> readers;
};

DdsListener::DdsListener(const DdsSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}
DdsListener::~DdsListener() = default;

std::vector<DiscoveredEndpoint> DdsListener::endpoints() const { return impl_->directory.endpoints(); }

void DdsListener::listen(const DiscoveredEndpoint& writer, std::function<void(const RawSample&)> callback) {
  impl_->readers.push_back(
      std::make_unique<RawReader>(impl_->loop, impl_->participant, writer, std::move(callback)));
}

Time DdsListener::now() const { return EventLoop::now(); }
void DdsListener::run_until(Time when) { impl_->loop.run_until(when); }
void DdsListener::stop() { impl_->loop.stop(); }
bool DdsListener::stopped() const { return impl_->loop.stopped(); }

}  // namespace sidestep
