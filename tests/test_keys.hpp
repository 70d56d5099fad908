// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <span>
#include <string>

#include "common/file/temporary_folder.hpp"
#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "deploy/run/keys/key_list.hpp"
#include "deploy/run/keys/key_store.hpp"

namespace sidestep {

/// A temporary folder of keys, removed with this object.
class TestKeys {
 public:
  /// `identities` are written as for `sidestep keys issue`.
  explicit TestKeys(const std::vector<std::string>& identities, Time now = EventLoop::now())
      : now_(now), store_(created(folder(), now)) {
    for (const Identity& identity : parse_key_list(identities)) issue(identity);
  }

  std::string folder() const { return temporary_.file("keys"); }
  /// The folder of an identity's keys.
  std::string folder_of(const std::string& identity) const {
    return key_folder_of(folder(), parse_identity(identity).value());
  }
  KeyStore& store() { return store_; }
  /// The time from which the authorities' and issued keys are valid.
  Time now() const { return now_; }
  std::string issue(const Identity& identity, Duration validity = std::chrono::hours(1)) {
    return store_.issue(identity, now_, now_ + validity);
  }
  /// Returns the number of newly revoked keys.
  std::size_t revoke(const Identity& identity) {
    return store_.revoke(std::span(&identity, 1), now_).front().revoked;
  }

 private:
  static KeyStore created(const std::string& folder, Time now) {
    KeyStore::create(folder, now, now + std::chrono::hours(24));
    return KeyStore(folder);
  }

  TemporaryFolder temporary_;
  Time now_;
  KeyStore store_;
};

}  // namespace sidestep
