// SPDX-License-Identifier: Apache-2.0
// Fast DDS 2.9 looks after each remote participant by a timer. One that fires while another thread removes
// that participant waits for it, then asserts that the participant is still there: the process is aborted,
// and a robot loses its agent because a neighbour has left. Later versions look first. Here is that check
// for 2.9; the dynamic linker takes a program's definition before the library's.
#include "common/messaging/dds_lease.hpp"

#include <dlfcn.h>
#include <fastrtps/config.h>

#if FASTRTPS_VERSION_MAJOR == 2 && FASTRTPS_VERSION_MINOR == 9
#include <chrono>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/builtin/discovery/participant/PDP.h>
#include <fastdds/rtps/resources/TimedEvent.h>
#include <fastrtps/utils/TimeConversion.h>
#include <mutex>

namespace eprosima::fastrtps::rtps {

void PDP::check_remote_participant_liveliness(ParticipantProxyData* remote) {
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

bool is_lease_check_ours() {
  static const int here = 0;
  Dl_info ours{}, called{};
  void* const check = dlsym(
      RTLD_DEFAULT,
      "_ZN8eprosima8fastrtps4rtps3PDP35check_remote_participant_livelinessEPNS1_20ParticipantProxyDataE");
  return check != nullptr && dladdr(&here, &ours) != 0 && dladdr(check, &called) != 0 &&
         ours.dli_fbase == called.dli_fbase;
}

}  // namespace sidestep
#else
namespace sidestep {

bool is_lease_check_ours() { return true; }  // the library's own is sound

}  // namespace sidestep
#endif
