// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "common/messaging/dds/endpoints.hpp"
#include "common/messaging/dds/type_mismatch_listener.hpp"

namespace sidestep {

/// Removes the shared-memory segments that killed processes have left in a folder. These are the segments
/// whose lock is free and whose age is at least `min_age`.
void remove_stale_segments(const std::filesystem::path& folder, std::chrono::seconds min_age);

/// The participant that writes images. It uses shared memory for readers on this host that also use it, and
/// UDP for all others. If shared memory is unavailable, it uses only UDP and logs a warning.
std::shared_ptr<DdsParticipant> image_publisher_participant(const DdsSettings& settings);

/// A bus's reader of images. It starts with shared memory, which fails silently if the writer cannot access
/// the same shared memory (for example in a container). Therefore, if a writer is known but no image arrives
/// for a second, the reader switches to UDP. After two more seconds it switches back to shared memory. The
/// timeout doubles at each switch, until an image arrives.
class DdsImageReader {
 public:
  /// Throws std::runtime_error if DdsReader does.
  DdsImageReader(EventLoop& loop, const DdsSettings& settings, const TypeMismatchListener& type_mismatches,
                 const TopicInfo& topic, const std::string& channel,
                 std::function<void(const void*)> callback);

  const DdsReader& reader() const { return reader_; }

 private:
  void check_silence();

  EventLoop& loop_;
  DdsSettings settings_;
  const TypeMismatchListener& type_mismatches_;
  std::string channel_;
  bool shares_memory_ = true;
  Time opened_at_;
  Time last_received_;
  Duration silence_timeout_;  ///< doubles until an image arrives
  DdsReader reader_;
};

}  // namespace sidestep
