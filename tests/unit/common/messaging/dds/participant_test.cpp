// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/participant.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <optional>

#include "common/file/write_file.hpp"
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

TEST_CASE("if Fast DDS refuses keys that look right, the error contains the reason of Fast DDS") {
  const TestKeys keys({"agent", "3"});
  const Authority authority(keys.folder() + "/public/permissions_ca.cert.pem",
                            keys.folder() + "/private/permissions_ca.key.pem");
  const std::string governance = keys.folder_of("agent 3") + "/governance.p7s";
  fs::remove(governance);
  write_file(governance, authority.sign("<dds></dds>"));
  CHECK_THROWS_WITH(DdsParticipant(settings_with(keys), nullptr),
                    ContainsSubstring("DDS failed to create a participant") &&
                        ContainsSubstring("with the keys in " + keys.folder_of("agent 3")) &&
                        ContainsSubstring(": Fast DDS says: ") && ContainsSubstring("domain_access_rules"));
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
