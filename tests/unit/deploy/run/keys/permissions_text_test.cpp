// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/permissions_text.hpp"

#include <set>

#include "common/keys/signed_document.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/topic_access.hpp"
#include "tests/catch.hpp"

namespace sidestep::permissions_text_test {

/// The topics between <publish> or <subscribe> and its end.
std::set<std::string> topics_in(const std::string& text, const std::string& rule) {
  std::set<std::string> result;
  const std::string open = "<topic>", close = "</topic>";
  const auto begin = text.find("<" + rule + ">"), end = text.find("</" + rule + ">");
  if (begin == std::string::npos) return result;
  for (auto at = text.find(open, begin); at < end; at = text.find(open, at + 1))
    result.insert(text.substr(at + open.size(), text.find(close, at) - at - open.size()));
  return result;
}

std::string permissions_of(const char* identity) {
  return permissions_text(parse_identity(identity).value(), std::string("CN=") + identity + ",O=Sidestep",
                          time_from_ns(1'800'000'000'000'000'000), time_from_ns(1'831'536'000'000'000'000));
}

TEST_CASE("permissions state their owner and validity period, and deny everything else") {
  const std::string text = permissions_of("agent 3");
  CHECK_THAT(text, ContainsSubstring("<subject_name>CN=agent 3,O=Sidestep</subject_name>"));
  CHECK_THAT(text, ContainsSubstring("<not_before>2027-01-15T08:00:00</not_before>"));
  CHECK_THAT(text, ContainsSubstring("<not_after>2028-01-15T08:00:00</not_after>"));
  CHECK_THAT(text, ContainsSubstring("<default>DENY</default>"));
}

TEST_CASE("permissions and governance cover every domain that programs accept") {
  for (const std::string& text : {permissions_of("agent 3"), governance_text()}) {
    for (int domain = 0; domain <= kMaxDomain; ++domain) {
      CAPTURE(domain);
      CHECK(covers_domain(text, domain));
    }
    CHECK_FALSE(covers_domain(text, kMaxDomain + 1));
  }
}

TEST_CASE("an agent's permissions include its own robot's channels") {
  const std::string text = permissions_of("agent 3");
  CHECK(topics_in(text, "publish") ==
        std::set<std::string>{"command/3", "registration", "proposal", "agent_orders", "order_status",
                              "course", "course_offer", "status", "counters", "clock_reading", "rules"});
  CHECK(topics_in(text, "subscribe").count("feedback/3") == 1);
  CHECK(topics_in(text, "subscribe").count("feedback/*") == 0);
  CHECK(topics_in(text, "subscribe").count("truth") == 0);
}

TEST_CASE("agents publish courses to coordinators, and read them only from coordinators") {
  const std::string agent = permissions_of("agent 3"), coordinator = permissions_of("coordinator 1");
  for (const std::string topic : {"course", "course_offer"}) {
    CAPTURE(topic);
    CHECK(topics_in(agent, "publish").contains(topic));
    CHECK_FALSE(topics_in(agent, "subscribe").contains(topic));
    CHECK(topics_in(coordinator, "subscribe").contains(topic));
    CHECK_FALSE(topics_in(coordinator, "publish").contains(topic));
    CHECK(topics_in(coordinator, "publish").contains("shared_" + topic));
    CHECK_FALSE(topics_in(agent, "publish").contains("shared_" + topic));
    CHECK(topics_in(agent, "subscribe").contains("shared_" + topic));
  }
}

TEST_CASE("permissions allow exactly what the topic table says") {
  for (const char* name : {"agent 3", "coordinator 1", "vision", "simulator", "robot 2-4", "referee",
                           "client a", "operator", "viewer", "judge"}) {
    CAPTURE(name);
    const Identity identity = parse_identity(name).value();
    const std::string text = permissions_of(name);
    for (const bool writes : {true, false}) {
      const std::set<std::string> allowed = topics_in(text, writes ? "publish" : "subscribe");
      std::set<std::string> others = allowed;
      for (const TopicInfo& topic : all_topics()) {
        for (std::uint32_t robot = 0; robot < 6; ++robot) {
          const std::string channel = channel_name(topic, robot), all = std::string(topic.name) + "/*";
          CAPTURE(channel, writes);
          const bool is_allowed = allowed.count(channel) > 0 || allowed.count(all) > 0;
          others.erase(channel);
          others.erase(all);
          CHECK(is_allowed == (writes ? may_write : may_read)(identity, topic, robot));
        }
      }
      CHECK(others.empty());
    }
  }
}

TEST_CASE("all topics are encrypted and access-controlled, but datagrams as a whole are not protected") {
  const std::string text = governance_text();
  CHECK_THAT(text, ContainsSubstring("<allow_unauthenticated_participants>false<"));
  CHECK_THAT(text, ContainsSubstring("<enable_join_access_control>true<"));
  CHECK_THAT(text, ContainsSubstring("<enable_read_access_control>true<"));
  CHECK_THAT(text, ContainsSubstring("<enable_write_access_control>true<"));
  CHECK_THAT(text, ContainsSubstring("<metadata_protection_kind>ENCRYPT<"));
  CHECK_THAT(text, ContainsSubstring("<rtps_protection_kind>NONE<"));
  CHECK_THAT(text, ContainsSubstring("<topic_expression>*<"));
}

}  // namespace sidestep::permissions_text_test
