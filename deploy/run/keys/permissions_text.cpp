// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/permissions_text.hpp"

#include <fmt/format.h>

#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/topic_access.hpp"

namespace sidestep {
namespace {

/// All DDS domains that programs accept.
std::string all_domains() {
  return fmt::format("<domains><id_range><min>0</min><max>{}</max></id_range></domains>", kMaxDomain);
}

std::string xml_time(Time time) { return utc_text(time, "%Y-%m-%dT%H:%M:%S"); }

/// The channels of a topic that the identity may use; `may` is may_write or may_read.
std::string topics_of(const Identity& identity, const TopicInfo& topic,
                      bool (*may)(const Identity&, const TopicInfo&, std::uint32_t)) {
  constexpr std::uint32_t kNobody = 4294967295;
  if (!topic.per_robot)
    return may(identity, topic, 0) ? fmt::format("          <topic>{}</topic>\n", topic.name) : "";
  if (may(identity, topic, kNobody)) return fmt::format("          <topic>{}/*</topic>\n", topic.name);
  std::string result;
  for (std::uint32_t robot = identity.first; robot <= identity.last; ++robot) {
    if (may(identity, topic, robot))
      result += fmt::format("          <topic>{}</topic>\n", channel_name(topic, robot));
  }
  return result;
}

std::string rule(const char* kind, const std::string& topics) {
  if (topics.empty()) return "";
  return fmt::format("        <{}>\n          <topics>\n{}          </topics>\n        </{}>\n", kind, topics,
                     kind);
}

}  // namespace

std::string governance_text() {
  return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<dds>
  <domain_access_rules>
    <domain_rule>
      {}
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>NONE</discovery_protection_kind>
      <liveliness_protection_kind>NONE</liveliness_protection_kind>
      <rtps_protection_kind>NONE</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>false</enable_discovery_protection>
          <enable_liveliness_protection>false</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)",
                     all_domains());
}

std::string permissions_text(const Identity& identity, const std::string& subject, Time from, Time until) {
  std::string written, read;
  for (const TopicInfo& topic : all_topics()) {
    written += topics_of(identity, topic, may_write);
    read += topics_of(identity, topic, may_read);
  }
  return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<dds>
  <permissions>
    <grant name="{}">
      <subject_name>{}</subject_name>
      <validity>
        <not_before>{}</not_before>
        <not_after>{}</not_after>
      </validity>
      <allow_rule>
        {}
{}{}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)",
                     to_text(identity), subject, xml_time(from), xml_time(until), all_domains(),
                     rule("publish", written), rule("subscribe", read));
}

}  // namespace sidestep
