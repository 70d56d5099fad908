// SPDX-License-Identifier: Apache-2.0
// Two of Fast DDS's ways to deal with leases that run out, as they should be. The dynamic linker takes a
// program's definition of a function before the library's, so they stand here under its names. As in Fast DDS
// 2.9.1.
#include "common/messaging/dds/lease.hpp"

#include <atomic>
#include <chrono>
#include <dlfcn.h>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/builtin/discovery/participant/PDP.h>
#include <fastdds/rtps/resources/TimedEvent.h>
#include <fastdds/rtps/writer/ReaderProxy.h>
#include <fastrtps/utils/TimeConversion.h>
#include <mutex>
#include <stdexcept>

namespace {

using namespace eprosima::fastrtps::rtps;

std::atomic<std::uint64_t> checks = 0;

using AckedChangesSet = void (*)(ReaderProxy*, const SequenceNumber_t&);

/// The library's own ReaderProxy::acked_changes_set(); nullptr: it has none.
AckedChangesSet acknowledge() {
  static const auto found = reinterpret_cast<AckedChangesSet>(dlsym(
      RTLD_NEXT, "_ZN8eprosima8fastrtps4rtps11ReaderProxy17acked_changes_setERKNS1_16SequenceNumber_tE"));
  return found;
}

}  // namespace

namespace eprosima::fastrtps::rtps {

/// Each remote participant is looked after by a timer. The library's check, when another thread removes the
/// participant meanwhile, waits for that, then asserts that the participant is still there: the process is
/// aborted, and a robot loses its agent because a neighbour has left.
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

/// A reader asks for everything from `base` on, and has everything before. One that took this process for
/// dead, because it slept or could not be heard, has forgotten what it had, and this process, which did not
/// take it for dead, has not: it would never send again what was acknowledged once, so its endpoints would
/// stay unknown there for ever. To the library a reader has forgotten only if it says so by 0, which it
/// leaves out when a heartbeat comes first.
void ReaderProxy::acked_changes_set(const SequenceNumber_t& base) {
  const SequenceNumber_t nothing;
  if (base > nothing && base <= changes_low_mark()) acknowledge()(this, nothing);
  acknowledge()(this, base);
}

}  // namespace eprosima::fastrtps::rtps

namespace sidestep {

void check_library() {
  if (!acknowledge())
    throw std::runtime_error("Fast DDS is not the version that this program was made for, 2.9.1");
}

Duration participant_lease() { return std::chrono::seconds(4); }

std::uint64_t lease_checks() { return checks; }

}  // namespace sidestep
