// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/launcher_input.hpp"

#include <array>
#include <cerrno>
#include <poll.h>
#include <unistd.h>

namespace sidestep {

void LauncherInput::read_once(int timeout_ms) {
  pollfd entry{descriptor_, POLLIN, 0};
  if (has_ended_ || ::poll(&entry, 1, timeout_ms) <= 0) return;
  std::array<char, 256> buffer{};
  const ssize_t count = read(descriptor_, buffer.data(), buffer.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count <= 0)
    has_ended_ = true;
  else
    unread_.append(buffer.data(), static_cast<std::size_t>(count));
}

std::string LauncherInput::read_token() {
  std::size_t end = std::string::npos;
  while ((end = unread_.find('\n')) == std::string::npos && !has_ended_) read_once(-1);
  if (end == std::string::npos) return {};
  const std::string token = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return token;
}

void LauncherInput::poll() {
  read_once(0);
  for (std::size_t end = unread_.find('\n'); end != std::string::npos; end = unread_.find('\n')) {
    is_run_over_ = is_run_over_ || unread_.substr(0, end) == kRunIsOver;
    unread_.erase(0, end + 1);
  }
}

}  // namespace sidestep
