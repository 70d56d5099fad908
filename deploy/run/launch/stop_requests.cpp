// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/stop_requests.hpp"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/eventfd.h>
#include <unistd.h>

namespace sidestep {
namespace {

constexpr auto kRepetition = std::chrono::milliseconds(1000);

int new_event() {
  const int event = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (event < 0) throw std::runtime_error(std::string("cannot create an event: ") + std::strerror(errno));
  return event;
}

void set_event(int event) {
  const int saved_errno = errno;
  const std::uint64_t one = 1;
  (void)!write(event, &one, sizeof one);
  errno = saved_errno;
}

}  // namespace

bool is_readable(int descriptor) {
  pollfd entry{descriptor, POLLIN, 0};
  return ::poll(&entry, 1, 0) == 1;
}

StopRequests::StopRequests() : stop_(new_event()), give_up_(new_event()) {
  signals_.emplace([this] { set_event(stop_); }, [this] { set_event(give_up_); });
}

StopRequests::~StopRequests() {
  signals_.reset();
  close(stop_);
  close(give_up_);
}

void PassedSignal::update(pid_t child, Time now) {
  if (!is_readable(request_) || (last_at_ && now - *last_at_ <= kRepetition)) return;
  last_at_ = now;
  if (!first_at_) first_at_ = now;
  kill(child, signal_);
}

}  // namespace sidestep
