// SPDX-License-Identifier: Apache-2.0
// Fast DDS looks after each remote participant by a timer. One that fires while another thread removes that
// participant waits for it, then asserts that the participant is still there: the process is aborted, and a
// robot loses its agent because a neighbour has left. Here is the same check without that; the dynamic linker
// takes a program's definition before the library's. As in Fast DDS 2.9.1.
#include "common/messaging/dds_lease.hpp"

#include <atomic>
#include <chrono>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/builtin/discovery/participant/PDP.h>
#include <fastdds/rtps/resources/TimedEvent.h>
#include <fastrtps/utils/TimeConversion.h>
#include <mutex>

namespace {

std::atomic<std::uint64_t> checks = 0;

}  // namespace

namespace eprosima::fastrtps::rtps {

void PDP::check_remote_participant_liveliness(ParticipantProxyData* remote) {
  ++checks;
  std::unique_lock<std::recursive_mutex> lock(*getMutex());
  const GUID_t guid = remote->m_guid;
  if (!remote->should_check_lease_duration || guid == GUID_t::unknown()) return;
  const std::chrono::microseconds lease(TimeConv::Duration_t2MicroSecondsInt64(remote->m_leaseDuration));
  const auto left = remote->last_received_message_tm() + lease - std::chrono::steady_clock::now();
  if (left.count() < 0) {
    lock.unlock();
    remove_remote_participant(guid, ParticipantDiscoveryInfo::DROPPED_PARTICIPANT);
    return;
  }
  remote->lease_duration_event->update_interval_millisec(
      std::chrono::duration<double, std::milli>(left).count());
  remote->lease_duration_event->restart_timer();
}

}  // namespace eprosima::fastrtps::rtps

namespace sidestep {

Duration participant_lease() { return std::chrono::seconds(4); }

std::uint64_t lease_checks() { return checks; }

}  // namespace sidestep
