// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/participant.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fmt/core.h>
#include <ifaddrs.h>
#include <mutex>
#include <netinet/in.h>
#include <random>
#include <sstream>
#include <stdexcept>

#include "common/keys/private_key.hpp"
#include "common/log/log.hpp"
#include "common/messaging/dds/destinations.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/library_log.hpp"
#include "common/messaging/dds/missing_interface.hpp"
#include "common/messaging/dds/open_network.hpp"
#include "common/messaging/dds/transport.hpp"
#include "common/messaging/reliability.hpp"
#include "common/messaging/topic_access.hpp"
#include "fast_dds_version.hpp"

namespace sidestep {
namespace {

namespace dds = fast_dds::dds;
using namespace fast_dds::dds;
using fast_dds::Duration_t;

constexpr std::uint32_t kMutationTries = 250;  ///< limits the number of participants on one host
const Duration_t kAnnouncementPeriod{1, 0};
constexpr std::uint32_t kSocketBufferBytes = 1 << 20;  ///< requested; the system may grant less
constexpr int kKeptStates = 64;                        ///< one second of states at one per cycle
constexpr int kMaxInstances = 2048;  ///< keys per endpoint; beyond that, idle ones are dropped

Duration_t milliseconds(std::uint32_t ms) { return Duration_t(0, ms * 1'000'000); }

/// Throws std::invalid_argument if the address is invalid.
fast_dds::rtps::Locator_t locator_at(const std::string& address) {
  fast_dds::rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  locator.port = 0;  // Fast DDS fills in the ports of all participants
  if (inet_pton(AF_INET, address.c_str(), locator.address + 12) != 1)
    throw std::invalid_argument(fmt::format("--peers: expected IPv4 addresses, got '{}'", address));
  return locator;
}

std::string own_addresses() {
  std::string result;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return result;
  for (const ifaddrs* i = first; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = {};
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr, text, sizeof text);
    result += std::string(result.empty() ? "" : " ") + text;
  }
  freeifaddrs(first);
  return result;
}

void check(const DdsSettings& settings) {
  if (settings.domain < 0 || settings.domain > kMaxDomain) {
    throw std::invalid_argument(fmt::format("--domain: expected 0..{}, got {}", kMaxDomain, settings.domain));
  }
  if (settings.interface == "all") return;
  // If the address belongs to another machine, Fast DDS would have no interface and report no error.
  const std::string own = own_addresses();
  if (!settings.interface.empty() &&
      (" " + own + " ").find(" " + settings.interface + " ") != std::string::npos)
    return;
  const std::string problem = fmt::format(
      "--interface: expected 'all' or an address of this machine ({}), got '{}'", own, settings.interface);
  in_addr address{};
  if (inet_pton(AF_INET, settings.interface.c_str(), &address) != 1) throw std::invalid_argument(problem);
  throw MissingInterface(problem);
}

ParticipantId id_of(const fast_dds::rtps::GuidPrefix_t& prefix) {
  ParticipantId result;
  std::ranges::copy(prefix.value, result.begin());
  return result;
}

class NoListener : public fast_dds::DiscoveryListener {
  void on_endpoint(const fast_dds::rtps::GUID_t&, DiscoveredEndpoint&&, EndpointChange) override {}
};

ParticipantId random_id() {
  std::random_device random;
  ParticipantId result;
  for (std::uint8_t& byte : result) byte = static_cast<std::uint8_t>(random());
  return result;
}

/// Sets the properties of Fast DDS's security plugins (DDS Security 1.1, 9.3 to 9.5).
void set_security_properties(const KeyFolder& keys, DomainParticipantQos& qos) {
  auto& properties = qos.properties().properties();
  const auto set = [&](const std::string& name, const std::string& value) {
    properties.emplace_back(name, value);
  };
  const auto set_file = [&](const std::string& name, const char* file) {
    set(name, "file://" + keys.file(file));
  };
  const std::string authentication = "dds.sec.auth.builtin.PKI-DH.",
                    access = "dds.sec.access.builtin.Access-Permissions.";
  set("dds.sec.auth.plugin", "builtin.PKI-DH");
  set_file(authentication + "identity_ca", key_files::kIdentityAuthority);
  set_file(authentication + "identity_certificate", key_files::kCertificate);
  set_file(authentication + "identity_crl", key_files::kRevoked);
  set_file(authentication + "private_key", key_files::kPrivateKey);
  set("dds.sec.access.plugin", "builtin.Access-Permissions");
  set_file(access + "permissions_ca", key_files::kPermissionsAuthority);
  set_file(access + "governance", key_files::kGovernance);
  set_file(access + "permissions", key_files::kPermissions);
  set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
  // The announcement must be signed for the id that Fast DDS derives from this candidate.
  const ParticipantId candidate = random_id();
  std::ranges::copy(candidate, qos.wire_protocol().prefix.value);
  qos.user_data().setValue(credentials(keys.certificate, load_private_key(keys.file(key_files::kPrivateKey)),
                                       fast_dds_version(), keys.certificate.guid_prefix(candidate),
                                       EventLoop::now()));
  // Governance does not protect discovery, so the endpoints for protected discovery would never be used.
  auto& endpoints = qos.wire_protocol().builtin.discovery_config.m_simpleEDP;
  endpoints.enable_builtin_secure_publications_writer_and_subscriptions_reader = false;
  endpoints.enable_builtin_secure_subscriptions_writer_and_publications_reader = false;
}

DomainParticipantQos participant_qos(const DdsSettings& settings,
                                     const std::shared_ptr<Impairment>& impairment,
                                     const std::shared_ptr<TransportCounts>& counts,
                                     const std::optional<KeyFolder>& keys,
                                     const std::shared_ptr<ParticipantFilter>& filter,
                                     std::uint32_t shared_memory_bytes) {
  DomainParticipantQos qos = PARTICIPANT_QOS_DEFAULT;
  qos.name(settings.participant);
  auto udp = std::make_shared<fast_dds::transport::UDPv4TransportDescriptor>();
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  if (!settings.peers.empty()) udp->maxInitialPeersRange = kPortsPerPeer;
  if (settings.interface != "all") udp->interfaceWhiteList.push_back(settings.interface);
  qos.transport().use_builtin_transports = false;
  if (shared_memory_bytes > 0) {
    auto memory = std::make_shared<fast_dds::transport::SharedMemTransportDescriptor>();
    memory->segment_size(shared_memory_bytes);
    qos.transport().user_transports.push_back(memory);
  }
  qos.transport().user_transports.push_back(udp_transport(udp, impairment, counts, filter));
  if (keys) set_security_properties(*keys, qos);
  // With keys, the keys determine who is an operator.
  if (settings.is_operator && !keys) qos.wire_protocol().prefix = operator_prefix();
  auto& builtin = qos.wire_protocol().builtin;
  builtin.mutation_tries = kMutationTries;
  builtin.discovery_config.leaseDuration = fast_dds::kInfiniteDuration;  // see Presence
  builtin.discovery_config.leaseDuration_announcementperiod = kAnnouncementPeriod;
  for (const std::string& peer : settings.peers) builtin.initialPeersList.push_back(locator_at(peer));
  // If the participant has an explicit address for discovery, Fast DDS uses no multicast.
  if (!settings.peers.empty())
    builtin.metatrafficUnicastLocatorList.push_back(
        locator_at(settings.interface == "all" ? "0.0.0.0" : settings.interface));
  fast_dds::disable_type_propagation(qos);
  return qos;
}

template <typename EndpointQos>
void set_common(EndpointQos& qos, Qos kind, int state_depth) {
  const int depth = kind == Qos::kEvent ? static_cast<int>(kEventDepth) : state_depth;
  qos.reliability().kind = kind == Qos::kEvent ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = VOLATILE_DURABILITY_QOS;
  qos.history().kind = KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.resource_limits().max_instances = kMaxInstances;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().max_samples = kMaxInstances * depth;
  qos.resource_limits().allocated_samples = depth;
  qos.endpoint().history_memory_policy = fast_dds::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

void warn_of_expiry(const KeyFolder& keys) {
  constexpr std::chrono::hours kSoon(7 * 24);
  static std::once_flag once;
  if (const Time end = keys.certificate.not_after(); end - EventLoop::now() < kSoon)
    std::call_once(once, [&] {
      log(LogLevel::kWarning,
          fmt::format("keys: other processes will refuse this one after {}, when its key expires",
                      date_text(end)));
    });
}

void warn_of_keys() {
  static std::once_flag once;
  std::call_once(once, [] {
    log(LogLevel::kWarning,
        "a run with keys is here, and ignores this process, which has none: --keys FOLDER");
  });
}

std::runtime_error failure(const std::string& entity, const std::string& channel, bool has_keys) {
  return std::runtime_error(fmt::format(
      "DDS failed to create the {} of topic '{}'{}", entity, channel,
      has_keys ? "; keys that an earlier version issued may not allow it: `sidestep keys issue --again`"
               : ""));
}

}  // namespace

DdsParticipant::DdsParticipant(const DdsSettings& settings, fast_dds::DiscoveryListener* listener,
                               std::uint32_t shared_memory_bytes)
    : own_listener_(listener == nullptr ? std::make_unique<NoListener>() : nullptr),
      listener_(listener == nullptr ? own_listener_.get() : listener),
      keeps_all_(settings.keeps_all) {
  check(settings);
  if (!settings.keys.empty()) {
    keys_ = load_key_folder(own_key_folder(settings.keys, settings.identity), EventLoop::now());
    require_domain(*keys_, settings.domain);
    warn_of_expiry(*keys_);
    filter_ = std::make_shared<ParticipantFilter>(*keys_, fast_dds_version());
    listener_->on_authentication = [filter = filter_](const fast_dds::rtps::GuidPrefix_t& prefix,
                                                      bool is_genuine) {
      filter->on_authentication(id_of(prefix), is_genuine);
    };
  } else if (!settings.is_local_bus) {
    require_safe_network(settings);
    // Participants for images may share a listener that is already in use.
    if (!listener_->on_announcement) {
      listener_->on_announcement = [meets_keys = meets_keys_](std::span<const std::uint8_t> user_data) {
        if (announces_keys(user_data) && !meets_keys->exchange(true)) warn_of_keys();
      };
    }
  }
  log_library();
  if (settings.faults) impairment_ = std::make_shared<Impairment>();
  fast_dds::disable_intraprocess_delivery();
  (void)take_library_errors();  // discards errors of other participants
  participant_ = DomainParticipantFactory::get_instance()->create_participant(
      static_cast<DomainId_t>(settings.domain),
      participant_qos(settings, impairment_, counts_, keys_, filter_, shared_memory_bytes), listener_,
      StatusMask::none());
  if (participant_ == nullptr) {
    const std::string reason = take_library_errors();
    throw std::runtime_error(
        fmt::format("DDS failed to create a participant in domain {} on interface {}{}: {}", settings.domain,
                    settings.interface, keys_ ? " with the keys in " + keys_->path : "",
                    reason.empty() ? "it gives no reason" : "Fast DDS says: " + reason));
  }
  if (filter_) filter_->set_self(id_of(participant_->guid().guidPrefix));
  publisher_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  if (publisher_ == nullptr || subscriber_ == nullptr)
    throw std::runtime_error("DDS failed to create a publisher or subscriber");
}

DdsParticipant::~DdsParticipant() {
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

dds::Topic* DdsParticipant::topic(const std::string& channel, const TypeSupport& type) {
  const std::string& type_name = type.get_type_name();
  if (TopicDescription* known = participant_->lookup_topicdescription(channel)) {
    if (known->get_type_name() != type_name) {
      throw std::runtime_error(fmt::format("topic '{}' is used with type {} and with type {}", channel,
                                           known->get_type_name(), type_name));
    }
    return static_cast<dds::Topic*>(known);
  }
  if (participant_->find_type(type_name).empty()) type.register_type(participant_);
  dds::Topic* created = participant_->create_topic(channel, type_name, TOPIC_QOS_DEFAULT);
  if (created == nullptr) throw failure("topic", channel, keys_.has_value());
  return created;
}

/// Reports missing permissions, because Fast DDS would refuse the operation without saying why.
void DdsParticipant::require_permission(const std::string& channel, bool writes) const {
  if (!keys_) return;
  for (const TopicInfo& topic : all_topics()) {
    const auto robot = channel_robot(topic, channel);
    if (robot && !(writes ? may_write : may_read)(keys_->identity, topic, *robot))
      throw std::invalid_argument(fmt::format("the keys of {} do not allow {} the topic '{}'",
                                              to_text(keys_->identity), writes ? "writing" : "reading",
                                              channel));
  }
}

DataWriter* DdsParticipant::create_writer(const std::string& channel, const TypeSupport& type,
                                          const DataWriterQos& qos, DataWriterListener* listener) {
  require_permission(channel, true);
  const StatusMask mask = StatusMask::publication_matched() << StatusMask::offered_incompatible_qos();
  DataWriter* writer = publisher_->create_datawriter(topic(channel, type), qos, listener, mask);
  if (writer == nullptr) throw failure("writer", channel, keys_.has_value());
  return writer;
}

DataReader* DdsParticipant::create_reader(const std::string& channel, const TypeSupport& type,
                                          const DataReaderQos& qos, DataReaderListener* listener) {
  require_permission(channel, false);
  const StatusMask mask = StatusMask::data_available() << StatusMask::requested_incompatible_qos();
  DataReader* reader = subscriber_->create_datareader(topic(channel, type), qos, listener, mask);
  if (reader == nullptr) throw failure("reader", channel, keys_.has_value());
  return reader;
}

DataReaderQos DdsParticipant::reader_qos(Qos qos) const {
  return dds_reader_qos(qos, keeps_all_ && qos == Qos::kState ? kKeptStates : 1);
}

void DdsParticipant::delete_writer(DataWriter* writer) { publisher_->delete_datawriter(writer); }

void DdsParticipant::delete_reader(DataReader* reader) { subscriber_->delete_datareader(reader); }

std::string dds_locators(const DataReader& reader) {
  fast_dds::transport::LocatorList locators;
  if (!fast_dds::is_ok(reader.get_listening_locators(locators))) return {};
  std::ostringstream text;
  text << locators;
  return text.str();
}

DataWriterQos dds_writer_qos(Qos kind) {
  DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
  set_common(qos, kind, 1);
  qos.publish_mode().kind = SYNCHRONOUS_PUBLISH_MODE;
  fast_dds::set_times(qos, Duration_t(0, static_cast<std::uint32_t>(kHeartbeatPeriod.count())),
                      milliseconds(1));
  return qos;
}

DataReaderQos dds_reader_qos(Qos kind, int depth) {
  DataReaderQos qos = DATAREADER_QOS_DEFAULT;
  set_common(qos, kind, depth);
  fast_dds::set_times(qos, milliseconds(1));
  return qos;
}

std::string dds_policy_name(QosPolicyId_t policy) {
  switch (policy) {
    case DURABILITY_QOS_POLICY_ID:
      return "durability";
    case PRESENTATION_QOS_POLICY_ID:
      return "presentation";
    case DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case LATENCYBUDGET_QOS_POLICY_ID:
      return "latency budget";
    case OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case PARTITION_QOS_POLICY_ID:
      return "partition";
    case RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case DESTINATIONORDER_QOS_POLICY_ID:
      return "destination order";
    case DATAREPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    case TYPECONSISTENCYENFORCEMENT_QOS_POLICY_ID:
      return "type consistency";
    default:
      return fmt::format("policy {}", static_cast<std::uint32_t>(policy));
  }
}

std::string fast_dds_version() { return kFastDdsVersion; }

void log_dds(const std::string& message) { log(LogLevel::kWarning, "dds: " + message); }

}  // namespace sidestep
