// SPDX-License-Identifier: Apache-2.0
// Tests which messages the filter passes and logs. admission_test.cpp tests whom it admits.
#include "common/messaging/dds/participant_filter.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <sys/stat.h>

#include "common/file/write_file.hpp"
#include "common/messaging/dds/datagram.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/participant_datagram.hpp"
#include "tests/test_keys.hpp"
#include "tests/text_of.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::participant_filter_test {

constexpr std::array<std::uint8_t, 4> kAddress{10, 0, 0, 7};

ParticipantId id_with(const Certificate& certificate) {
  ParticipantId id{};
  std::ranges::copy(certificate.prefix(), id.begin());
  return id;
}

struct Fixture {
  ParticipantId announce(const std::string& text) {
    const std::string folder = keys.folder_of(text);
    const Certificate certificate = Certificate::load(folder + "/cert.pem");
    const ParticipantId id = id_with(certificate);
    const auto announced =
        credentials(certificate, load_private_key(folder + "/key.pem"), "2.9.1", id, keys.now());
    CHECK(filter.passes(id, participant_datagram(id, announced), true, kAddress));
    return id;
  }

  TestKeys keys{{"agent", "3", "coordinator", "0", "client", "a", "operator", "viewer"}};
  ParticipantFilter filter{load_key_folder(keys.folder_of("coordinator 0"), keys.now()), "2.9.1"};
};

TEST_CASE("messages from participants that have not announced themselves are not passed on") {
  Fixture f;
  const ParticipantId stranger{1, 2, 3};
  const Datagram message{'R', 'T', 'P', 'S'};
  CHECK_FALSE(f.filter.passes(stranger, message, false, kAddress));
  CHECK(f.filter.unknown() == 1);
  const ParticipantId agent = f.announce("agent 3");
  CHECK(f.filter.passes(agent, message, false, kAddress));
  CHECK(f.filter.unknown() == 1);
}

TEST_CASE("a process may send only what its keys permit, and each violation is logged once") {
  Fixture f;
  const CaptureStderr log;
  const ParticipantId agent = f.announce("agent 3"), viewer = f.announce("viewer"),
                      client = f.announce("client a"), op = f.announce("operator");
  CHECK(f.filter.may_send(agent, topics::kProposal, 0, 3));
  CHECK(f.filter.may_send(agent, topics::kCommand, 3, 3));
  CHECK(f.filter.may_send(client, topics::kOrder, 0, client_id("a")));
  CHECK(f.filter.may_send(op, topics::kOrder, 0, static_cast<std::uint32_t>(Sender::kOperator)));
  CHECK(f.filter.forged() == 0);
  for (int i = 0; i < 3; ++i) CHECK_FALSE(f.filter.may_send(agent, topics::kProposal, 0, 4));
  CHECK_FALSE(f.filter.may_send(agent, topics::kCommand, 4, 3));
  CHECK_FALSE(f.filter.may_send(agent, topics::kVerdict, 3, 3));
  CHECK_FALSE(f.filter.may_send(client, topics::kOrder, 0, static_cast<std::uint32_t>(Sender::kOperator)));
  for (const TopicInfo& topic : all_topics()) CHECK_FALSE(f.filter.may_send(viewer, topic, 3, 3));
  CHECK_FALSE(f.filter.may_send({9, 9}, topics::kOrder, 0, client_id("a")));
  CHECK(f.filter.forged() == 3 + 3 + all_topics().size() + 1);
  CHECK(f.filter.is_operator(op));
  CHECK_FALSE(f.filter.is_operator(agent));
  const std::string line = "refuses messages of agent 3 on topic 'proposal' in the name of agent 4";
  const std::string text = log.text();
  REQUIRE(text.find(line) != std::string::npos);
  CHECK(text.find(line, text.find(line) + 1) == std::string::npos);
}

TEST_CASE("the revocation list is read again when it changes, and an unreadable list changes nothing") {
  Fixture f;
  const CaptureStderr log;
  const ParticipantId agent = f.announce("agent 3"), viewer = f.announce("viewer");
  CHECK(f.filter.newly_refused().empty());
  const std::string file = f.keys.folder() + "/public/crl.pem";
  const auto change = [&](const auto& how) {
    const auto before = std::filesystem::last_write_time(file);
    how();
    // File systems have coarse time stamps.
    std::filesystem::last_write_time(file, before + std::chrono::seconds(1));
  };
  change([&] { f.keys.revoke({Role::kAgent, 3, 3}); });
  CHECK(f.filter.newly_refused() == std::vector{agent});
  change([&] { write_file(file, "nonsense"); });
  CHECK(f.filter.newly_refused().empty());
  CHECK(log.has("the previous list remains in force"));
  CHECK_FALSE(f.filter.passes(agent, Datagram{'R', 'T', 'P', 'S'}, false, kAddress));
  CHECK(f.filter.passes(viewer, Datagram{'R', 'T', 'P', 'S'}, false, kAddress));
}

TEST_CASE("an older revocation list does not undo a revocation, and a pipe in its place does not block") {
  Fixture f;
  const CaptureStderr log;
  const ParticipantId agent = f.announce("agent 3");
  const std::string file = f.keys.folder() + "/public/crl.pem", older = text_of(file);
  f.keys.revoke({Role::kAgent, 3, 3});
  std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) + std::chrono::seconds(1));
  CHECK(f.filter.newly_refused() == std::vector{agent});
  write_file(file, older);
  std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) + std::chrono::seconds(2));
  CHECK(f.filter.newly_refused().empty());
  CHECK(log.has("no longer lists some revoked keys; they stay revoked"));
  CHECK_FALSE(f.filter.passes(agent, Datagram{'R', 'T', 'P', 'S'}, false, kAddress));
  std::filesystem::remove(file);
  REQUIRE(mkfifo(file.c_str(), 0600) == 0);
  CHECK(f.filter.newly_refused().empty());
  CHECK(log.has("the previous list remains in force"));
}

TEST_CASE("a participant that Fast DDS refuses is named") {
  Fixture f;
  const CaptureStderr log;
  f.filter.on_authentication(f.announce("agent 3"), false);
  CHECK(log.has(
      "refuses a process that announces itself as agent 3: its private key or certificate is not genuine"));
}

}  // namespace sidestep::participant_filter_test
