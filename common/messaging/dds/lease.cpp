// SPDX-License-Identifier: Apache-2.0
// Corrected versions of two Fast DDS functions that handle expired leases. They have the library's names, and
// the dynamic linker prefers a program's definition over a library's. They correspond to Fast DDS 2.9.1.
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

/// The library's ReaderProxy::acked_changes_set(); null if it has none.
AckedChangesSet library_acked_changes_set() {
  static const auto found = reinterpret_cast<AckedChangesSet>(dlsym(
      RTLD_NEXT, "_ZN8eprosima8fastrtps4rtps11ReaderProxy17acked_changes_setERKNS1_16SequenceNumber_tE"));
  return found;
}

}  // namespace

namespace eprosima::fastrtps::rtps {

/// The timer callback of each remote participant's lease. If another thread is removing the participant
/// meanwhile, the library's version waits for that, and then asserts that the participant still exists. The
/// process then aborts, and a robot loses its agent because a neighbour has left.
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

/// A reader requests all changes from `base` on, and acknowledges all earlier ones. A reader whose lease on
/// this process has expired (this process was stopped or cut off) has forgotten the changes that it had
/// acknowledged, while this process, whose lease on the reader has not expired, still regards them as
/// delivered. It would never send them again, so its endpoints would stay unknown to the reader for ever. The
/// library resends them only if the reader requests 0, which it omits when a heartbeat arrives first.
/// Therefore a request at or below the low mark is treated as one from 0.
void ReaderProxy::acked_changes_set(const SequenceNumber_t& base) {
  const SequenceNumber_t none;
  if (base > none && base <= changes_low_mark()) library_acked_changes_set()(this, none);
  library_acked_changes_set()(this, base);
}

}  // namespace eprosima::fastrtps::rtps

namespace sidestep {

void check_fast_dds_version() {
  if (!library_acked_changes_set())
    throw std::runtime_error("the installed Fast DDS is not version 2.9.1, which this program requires");
}

Duration participant_lease() { return std::chrono::seconds(4); }

std::uint64_t lease_check_count() { return checks; }

}  // namespace sidestep
