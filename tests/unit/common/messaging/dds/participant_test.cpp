// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/participant.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <optional>

#include "common/file/write_file.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/run/keys/permissions_text.hpp"
#include "tests/catch.hpp"
#include "tests/test_keys.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::participant_test {

namespace fs = std::filesystem;

DdsSettings settings_with(const TestKeys& keys) {
  DdsSettings settings = test_settings();
  settings.identity = {Role::kAgent, 3, 3};
  settings.keys = keys.folder();
  return settings;
}

/// Signs the text in place of a document of agent 3.
void replace_document(const TestKeys& keys, const char* name, const std::string& text) {
  const Authority authority(keys.folder() + "/public/permissions_ca.cert.pem",
                            keys.folder() + "/private/permissions_ca.key.pem");
  const std::string file = keys.folder_of("agent 3") + "/" + name;
  fs::remove(file);
  write_file(file, authority.sign(text));
}

TEST_CASE("if Fast DDS refuses keys that look right, the error contains the reason of Fast DDS") {
  const TestKeys keys({"agent", "3"});
  replace_document(keys, key_files::kGovernance,
                   "<dds><domains><id>" + std::to_string(test_settings().domain) + "</id></domains></dds>");
  CHECK_THROWS_WITH(DdsParticipant(settings_with(keys), nullptr),
                    ContainsSubstring("DDS failed to create a participant") &&
                        ContainsSubstring("with the keys in " + keys.folder_of("agent 3")) &&
                        ContainsSubstring(": Fast DDS says: ") && ContainsSubstring("domain_access_rules"));
}

TEST_CASE("with keys a process can write and read in the highest domain") {
  const TestKeys keys({"agent", "3"});
  DdsSettings settings = settings_with(keys);
  settings.domain = kMaxDomain;  // used by no other test
  DdsBus bus(settings);
  CHECK_NOTHROW((void)bus.advertise(topics::kCommand, 3));
  CHECK_NOTHROW(bus.subscribe<msg::WorldState>(topics::kWorld, [](const msg::WorldState&) {}));
}

TEST_CASE("two processes with keys refuse no datagram of each other") {
  const TestKeys keys({"agent", "3", "vision"});
  DdsBus agent(settings_with(keys));
  DdsSettings settings = settings_with(keys);
  settings.identity = {Role::kVision};
  DdsBus vision(settings);
  // Lasts most of a second. Fast DDS repeats unanswered questions every 70 ms.
  constexpr int kWorlds = 200;
  int received = 0;
  agent.subscribe<msg::WorldState>(topics::kWorld, [&](const msg::WorldState&) { ++received; });
  auto writer = vision.advertise(topics::kWorld);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  REQUIRE(run_until(
      [&] {
        writer.publish(world, vision.now());
        return received >= kWorlds;
      },
      agent, vision));
  for (const DdsBus* bus : {&agent, &vision}) {
    DropCounters drops;
    bus->count_drops(drops);
    CHECK(drops.total(DropReason::kMalformedDatagram) == 0);
    CHECK(drops.total(DropReason::kForgedSender) == 0);
  }
}

/// The document without the domains above `max`.
std::string up_to_domain(std::string text, int max) {
  const std::string all = fmt::format("<max>{}</max>", kMaxDomain);
  const auto at = text.find(all);
  REQUIRE(at != std::string::npos);
  return text.replace(at, all.size(), fmt::format("<max>{}</max>", max));
}

TEST_CASE("keys that do not cover the domain are refused with the reason") {
  const TestKeys keys({"agent", "3"});
  const Time from = keys.now() - std::chrono::hours(24), until = keys.now() + std::chrono::hours(24);
  const Identity agent{Role::kAgent, 3, 3};
  const auto [file, text] = GENERATE_COPY(table<const char*, std::string>(
      {{key_files::kGovernance, governance_text()},
       {key_files::kPermissions, permissions_text(agent, "CN=agent 3,O=Sidestep", from, until)}}));
  CAPTURE(file);
  DdsSettings settings = settings_with(keys);
  const int covered = settings.domain;
  replace_document(keys, file, up_to_domain(text, covered));
  settings.domain = covered + 1;
  CHECK_THROWS_AS(DdsParticipant(settings, nullptr), std::invalid_argument);
  CHECK_THROWS_WITH(
      DdsParticipant(settings, nullptr),
      ContainsSubstring(fmt::format("{}: these keys do not cover DDS domain {}", file, covered + 1)));
  settings.domain = covered;
  CHECK_NOTHROW(DdsParticipant(settings, nullptr));
}

TEST_CASE("an error about a topic that older keys do not allow says what to do") {
  const TestKeys keys({"agent", "3"});
  const Time from = keys.now() - std::chrono::hours(24), until = keys.now() + std::chrono::hours(24);
  std::string text = permissions_text({Role::kAgent, 3, 3}, "CN=agent 3,O=Sidestep", from, until);
  const std::string topic = "<topic>command/3</topic>";
  REQUIRE(text.find(topic) != std::string::npos);
  text.replace(text.find(topic), topic.size(), "<topic>earlier/3</topic>");
  replace_document(keys, key_files::kPermissions, text);
  DdsBus bus(settings_with(keys));
  CHECK_NOTHROW((void)bus.advertise(topics::kProposal, 3));
  CHECK_THROWS_WITH((void)bus.advertise(topics::kCommand, 3),
                    ContainsSubstring("'command/3'; keys that an earlier version issued may not allow it: "
                                      "`sidestep keys issue --again`"));
}

TEST_CASE("a process without keys notices that a run with keys is in its domain") {
  const TestKeys keys({"agent", "3"});
  DdsBus without(test_settings("without"));
  CHECK_FALSE(without.meets_keys());
  DdsBus with(settings_with(keys));
  CHECK(run_until([&] { return without.meets_keys(); }, without, with));
  CHECK_FALSE(with.meets_keys());
}

/// Sets the time zone of this process.
class TimeZone {
 public:
  explicit TimeZone(const char* name) {
    if (const char* const before = std::getenv("TZ")) before_ = before;
    set(name);
  }
  ~TimeZone() { set(before_ ? before_->c_str() : nullptr); }
  TimeZone(const TimeZone&) = delete;
  TimeZone& operator=(const TimeZone&) = delete;

 private:
  static void set(const char* name) {
    name == nullptr ? unsetenv("TZ") : setenv("TZ", name, 1);
    tzset();
  }
  std::optional<std::string> before_;
};

TEST_CASE("newly issued keys are valid on hosts in every time zone") {
  const TestKeys keys({"agent", "3"});
  const char* const zone = GENERATE("UTC", "XXX+12", "XXX-14");
  CAPTURE(zone);
  const TimeZone set(zone);
  CHECK_NOTHROW(DdsParticipant(settings_with(keys), nullptr));
}

}  // namespace sidestep::participant_test
