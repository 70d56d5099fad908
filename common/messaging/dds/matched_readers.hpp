// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <set>

#include "fast_dds/library.hpp"

namespace sidestep {

/// Writer listener that records the readers that match now. Thread-safe.
class MatchedReaders : public fast_dds::dds::DataWriterListener {
 public:
  void on_publication_matched(fast_dds::dds::DataWriter*,
                              const fast_dds::dds::PublicationMatchedStatus& status) override {
    const std::lock_guard lock(mutex_);
    const fast_dds::rtps::GUID_t reader = fast_dds::rtps::iHandle2GUID(status.last_subscription_handle);
    if (status.current_count_change > 0)
      guids_.insert(reader);
    else
      guids_.erase(reader);
  }
  std::set<fast_dds::rtps::GUID_t> guids() const {
    const std::lock_guard lock(mutex_);
    return guids_;
  }

 private:
  mutable std::mutex mutex_;
  std::set<fast_dds::rtps::GUID_t> guids_;
};

}  // namespace sidestep
