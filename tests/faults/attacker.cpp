// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/attacker.hpp"

#include <algorithm>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <map>
#include <random>
#include <stdexcept>

#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/types.hpp"
#include "fast_dds/library.hpp"

namespace sidestep {

AttackerKeys AttackerKeys::of(const std::string& folder) {
  const auto file = [&](const char* name) { return folder + "/" + name; };
  return {file(key_files::kIdentityAuthority), file(key_files::kCertificate),
          file(key_files::kPrivateKey),        file(key_files::kPermissionsAuthority),
          file(key_files::kGovernance),        file(key_files::kPermissions)};
}

struct Attacker::Impl {
  struct Writer {
    fast_dds::dds::DataWriter* writer;
    fast_dds::dds::TypeSupport type;
  };
  fast_dds::dds::DomainParticipant* participant = nullptr;
  fast_dds::dds::Publisher* publisher = nullptr;
  std::map<std::string, Writer> writers;
};

Attacker::Attacker(const AttackerSettings& settings) : impl_(std::make_unique<Impl>()) {
  fast_dds::dds::DomainParticipantQos qos = fast_dds::dds::PARTICIPANT_QOS_DEFAULT;
  qos.name("attacker");
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<fast_dds::transport::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().user_transports.push_back(udp);
  qos.wire_protocol().builtin.mutation_tries = 500;
  // Otherwise the test's own process may abort, see common/messaging/README.md.
  qos.wire_protocol().builtin.discovery_config.leaseDuration = fast_dds::kInfiniteDuration;
  if (settings.announced) {
    ParticipantId id;
    std::random_device random;
    for (std::uint8_t& byte : id) byte = static_cast<std::uint8_t>(random());
    if (settings.prefix) std::ranges::copy(*settings.prefix, id.begin());
    std::ranges::copy(id, qos.wire_protocol().prefix.value);
    if (settings.keys) id = Certificate::load(settings.keys->certificate).guid_prefix(id);
    qos.user_data().setValue(settings.announced(id));
  }
  if (settings.keys) {
    auto& properties = qos.properties().properties();
    const auto set = [&](const std::string& name, const std::string& value) {
      properties.emplace_back(name, value);
    };
    set("dds.sec.auth.plugin", "builtin.PKI-DH");
    set("dds.sec.auth.builtin.PKI-DH.identity_ca", "file://" + settings.keys->identity_authority);
    set("dds.sec.auth.builtin.PKI-DH.identity_certificate", "file://" + settings.keys->certificate);
    set("dds.sec.auth.builtin.PKI-DH.private_key", "file://" + settings.keys->private_key);
    set("dds.sec.access.plugin", "builtin.Access-Permissions");
    set("dds.sec.access.builtin.Access-Permissions.permissions_ca",
        "file://" + settings.keys->permissions_authority);
    set("dds.sec.access.builtin.Access-Permissions.governance", "file://" + settings.keys->governance);
    set("dds.sec.access.builtin.Access-Permissions.permissions", "file://" + settings.keys->permissions);
    set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
  }
  fast_dds::disable_intraprocess_delivery();
  impl_->participant = fast_dds::dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<fast_dds::dds::DomainId_t>(settings.domain), qos);
  if (impl_->participant == nullptr) throw std::runtime_error("the attacker's own library refuses its keys");
  impl_->publisher = impl_->participant->create_publisher(fast_dds::dds::PUBLISHER_QOS_DEFAULT);
}

Attacker::~Attacker() {
  if (impl_->participant == nullptr) return;
  impl_->participant->delete_contained_entities();
  fast_dds::dds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

void Attacker::write(const TopicInfo& topic, std::uint32_t robot, void* message) {
  const std::string channel = channel_name(topic, robot);
  auto found = impl_->writers.find(channel);
  if (found == impl_->writers.end()) {
    const fast_dds::dds::TypeSupport type(new GuardedType(topic.type));
    if (impl_->participant->find_type(type.get_type_name()).empty()) type.register_type(impl_->participant);
    fast_dds::dds::Topic* const dds_topic =
        impl_->participant->create_topic(channel, type.get_type_name(), fast_dds::dds::TOPIC_QOS_DEFAULT);
    fast_dds::dds::DataWriter* const writer =
        dds_topic == nullptr ? nullptr
                             : impl_->publisher->create_datawriter(dds_topic, dds_writer_qos(topic.qos));
    if (writer == nullptr)
      throw std::runtime_error("the attacker's own library refuses the topic " + channel);
    found = impl_->writers.emplace(channel, Impl::Writer{writer, type}).first;
  }
  GuardedType::Sample sample{message, true};
  if (!fast_dds::write(*found->second.writer, &sample)) throw std::runtime_error("the attacker cannot write");
}

int Attacker::readers() const {
  int count = 0;
  for (const auto& [channel, writer] : impl_->writers) {
    fast_dds::dds::PublicationMatchedStatus status;
    writer.writer->get_publication_matched_status(status);
    count += status.current_count;
  }
  return count;
}

}  // namespace sidestep
