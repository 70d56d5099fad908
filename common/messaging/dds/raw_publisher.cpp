// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/raw_publisher.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "common/messaging/dds/matched_readers.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"

namespace sidestep {
namespace {

using namespace fast_dds::dds;

/// Takes the key of each message from the caller, because the layout of the bytes is unknown here.
class KeyedRawType : public RawType {
 public:
  using RawType::RawType;

  bool key(const void*, fast_dds::rtps::InstanceHandle_t& handle) override {
    std::copy(next_key.begin(), next_key.end(), &handle.value[0]);
    return true;
  }

  CdrKey next_key{};
};

DataWriterQos compatible_qos() {
  DataWriterQos qos = dds_writer_qos(Qos::kEvent);
  qos.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
  return qos;
}

}  // namespace

struct DdsRawPublisher::Impl {
  Impl(const DdsSettings& settings, const std::string& topic, const std::string& name, bool is_keyed)
      : participant(settings, nullptr),
        type(new KeyedRawType(name, is_keyed)),
        support(type),
        writer(participant.create_writer(topic, support, compatible_qos(), &subscribers)) {}
  ~Impl() { participant.delete_writer(writer); }

  MatchedReaders subscribers;
  DdsParticipant participant;
  KeyedRawType* type;  ///< owned by `support`
  TypeSupport support;
  DataWriter* writer;
};

DdsRawPublisher::DdsRawPublisher(const DdsSettings& settings, const std::string& topic,
                                 const std::string& type, bool is_keyed)
    : impl_(std::make_unique<Impl>(settings, topic, type, is_keyed)) {}

DdsRawPublisher::~DdsRawPublisher() = default;

void DdsRawPublisher::write(std::span<const std::uint8_t> bytes, const CdrKey& key) {
  std::vector<std::uint8_t> sample(bytes.begin(), bytes.end());
  impl_->type->next_key = key;
  if (!fast_dds::write(*impl_->writer, &sample)) throw std::runtime_error("DDS failed to send the message");
}

std::set<std::string> DdsRawPublisher::readers() const {
  std::set<std::string> result;
  for (const fast_dds::rtps::GUID_t& guid : impl_->subscribers.guids()) {
    std::ostringstream text;
    text << guid;
    result.insert(text.str());
  }
  return result;
}

bool DdsRawPublisher::wait_until_acknowledged(Duration timeout) {
  const auto whole_s = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const fast_dds::Duration_t wait(static_cast<std::int32_t>(whole_s.count()),
                                  static_cast<std::uint32_t>((timeout - whole_s).count()));
  return fast_dds::is_ok(impl_->writer->wait_for_acknowledgments(wait));
}

}  // namespace sidestep
