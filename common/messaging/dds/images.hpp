// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "common/messaging/dds/endpoints.hpp"

namespace sidestep {

/// Removes what killed processes left in a folder of shared memory, whose locks are free, as long as it is so
/// old.
void remove_abandoned_memory(const std::filesystem::path& folder, std::chrono::seconds least_age);

/// The participant that writes images: by shared memory to those on this host who listen there, by UDP to all
/// others. Where there is no shared memory, by UDP alone, which it says on stderr.
std::shared_ptr<DdsParticipant> image_writing_participant(const DdsSettings& settings);

/// A bus's reader of images. It listens by shared memory; but that may fail without any error, where it is
/// not the writer's (containers). So when a new writer is known and nothing has come for a second, it listens
/// by UDP alone, and after two seconds more by shared memory again, and so on until something comes.
class DdsImageReader {
 public:
  /// Throws std::runtime_error as DdsReader does.
  DdsImageReader(EventLoop& loop, const DdsSettings& settings, const TypeMismatchListener& strangers,
                 const TopicInfo& topic, const std::string& channel,
                 std::function<void(const void*)> callback);

  const DdsReader& reader() const { return reader_; }

 private:
  void look();

  EventLoop& loop_;
  DdsSettings settings_;
  const TypeMismatchListener& strangers_;
  std::string channel_;
  bool shares_memory_ = true;
  Time opened_at_;
  Time heard_at_;
  Duration patience_;  ///< with silence; grows until something comes
  DdsReader reader_;
};

}  // namespace sidestep
