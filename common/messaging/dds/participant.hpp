// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <optional>
#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/participant_filter.hpp"
#include "common/messaging/dds/transport_counts.hpp"
#include "common/messaging/impairment.hpp"
#include "fast_dds/discovery_listener.hpp"
#include "fast_dds/library.hpp"

namespace sidestep {

/// A DDS participant with one publisher and one subscriber, over UDPv4 and optionally shared memory. Its
/// destructor deletes everything that it has created.
class DdsParticipant {
 public:
  /// The listener, if any, must outlive the participant. `shared_memory_bytes` > 0 is the size of the segment
  /// for written messages. Two participants on one host that both have shared memory use it instead of UDP,
  /// even if neither can see the other's segment (for example in containers); faults do not affect it. Throws
  /// std::runtime_error with the reason, and std::invalid_argument if the keys are wrong or missing.
  DdsParticipant(const DdsSettings& settings, fast_dds::DiscoveryListener* listener,
                 std::uint32_t shared_memory_bytes = 0);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;

  /// Creates a writer. Registers `type` unless a type with its name is already registered. Throws
  /// std::runtime_error that names the topic.
  fast_dds::dds::DataWriter* create_writer(const std::string& channel, const fast_dds::dds::TypeSupport& type,
                                           const fast_dds::dds::DataWriterQos& qos,
                                           fast_dds::dds::DataWriterListener* listener);
  fast_dds::dds::DataReader* create_reader(const std::string& channel, const fast_dds::dds::TypeSupport& type,
                                           const fast_dds::dds::DataReaderQos& qos,
                                           fast_dds::dds::DataReaderListener* listener);
  fast_dds::dds::DataReaderQos reader_qos(Qos qos) const;
  void delete_writer(fast_dds::dds::DataWriter* writer);
  void delete_reader(fast_dds::dds::DataReader* reader);
  /// See DdsBus::impair().
  void impair(const LinkQuality& quality, std::uint64_t seed) { impairment_->set(quality, seed); }
  const TransportCounts& counts() const { return *counts_; }
  /// Null if the process has no keys.
  ParticipantFilter* filter() const { return filter_.get(); }
  /// The identity whose keys this process has; nullptr if it has none.
  const Identity* identity() const { return keys_ ? &keys_->identity : nullptr; }
  /// See DdsBus::meets_keys(). Thread-safe.
  bool meets_keys() const { return *meets_keys_; }

 private:
  void require_permission(const std::string& channel, bool writes) const;
  fast_dds::dds::Topic* topic(const std::string& channel, const fast_dds::dds::TypeSupport& type);

  std::unique_ptr<fast_dds::DiscoveryListener> own_listener_;
  fast_dds::DiscoveryListener* listener_;
  std::shared_ptr<TransportCounts> counts_ = std::make_shared<TransportCounts>();
  const bool keeps_all_;
  std::shared_ptr<std::atomic<bool>> meets_keys_ = std::make_shared<std::atomic<bool>>(false);
  std::optional<KeyFolder> keys_;
  std::shared_ptr<ParticipantFilter> filter_;
  std::shared_ptr<Impairment> impairment_;  ///< null without DdsSettings::faults
  fast_dds::dds::DomainParticipant* participant_ = nullptr;
  fast_dds::dds::Publisher* publisher_ = nullptr;
  fast_dds::dds::Subscriber* subscriber_ = nullptr;
};

fast_dds::dds::DataWriterQos dds_writer_qos(Qos qos);
/// `depth` is the number of states per key that may wait to be read.
fast_dds::dds::DataReaderQos dds_reader_qos(Qos qos, int depth = 1);
/// The addresses on which the reader listens.
std::string dds_locators(const fast_dds::dds::DataReader& reader);
/// The policy's name, e.g. "reliability".
std::string dds_policy_name(fast_dds::dds::QosPolicyId_t policy);
/// Logs a DDS problem. Thread-safe.
void log_dds(const std::string& message);

}  // namespace sidestep
