// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/revoked_keys.hpp"

#include "common/keys/key_folder.hpp"
#include "deploy/run/launch/process_command.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod = std::chrono::seconds(1);

}  // namespace

RevokedKeys::RevokedKeys(const std::string& folder) : folder_(folder), time_(modification_time()) {}

std::filesystem::file_time_type RevokedKeys::modification_time() const {
  std::error_code none;
  return std::filesystem::last_write_time(folder_ + "/" + key_files::kRevoked, none);
}

std::optional<std::string> RevokedKeys::changed(Time now) {
  if (folder_.empty() || now < due_) return std::nullopt;
  due_ = now + kPeriod;
  const auto time = modification_time();
  if (time == time_) return std::nullopt;
  time_ = time;
  return read_key_file(folder_, key_files::kRevoked);
}

}  // namespace sidestep
