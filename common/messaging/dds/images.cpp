// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/images.hpp"

#include <algorithm>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fmt/core.h>
#include <stdexcept>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace sidestep {
namespace {

constexpr Duration kSilence{1'000'000'000}, kLongestSilence{16'000'000'000};
constexpr std::uint32_t kImagesBytes = 32 << 20;  ///< of all images that wait for their readers
constexpr std::uint32_t kReaderBytes = 1 << 18;   ///< who reads images says little
constexpr std::chrono::seconds kMaking{5};        ///< who is just making some has no lock on it yet
constexpr Duration kLook{250'000'000};

std::shared_ptr<DdsParticipant> make(const DdsSettings& settings, std::uint32_t shared_memory_bytes) {
  DdsSettings named = settings;
  named.participant += "-images";
  return std::make_shared<DdsParticipant>(named, nullptr, shared_memory_bytes);
}

std::shared_ptr<DdsParticipant> make_sharing(const DdsSettings& settings, std::uint32_t bytes) {
  remove_abandoned_memory("/dev/shm", kMaking);
  try {
    return make(settings, bytes);
  } catch (const std::runtime_error&) {
    auto participant = make(settings, 0);
    log_dds("no shared memory: images go by UDP");
    return participant;
  }
}

}  // namespace

void remove_abandoned_memory(const std::filesystem::path& folder, std::chrono::seconds least_age) {
  constexpr std::string_view kBegin = "fastrtps_", kEnd = "_el";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) continue;
    const int lock = open(entry.path().c_str(), O_RDONLY);
    if (lock < 0) continue;
    struct stat facts {};
    const bool is_old = fstat(lock, &facts) == 0 && std::time(nullptr) - facts.st_ctime >= least_age.count();
    if (is_old && flock(lock, LOCK_EX | LOCK_NB) == 0) {
      const std::string path = entry.path().string();
      std::filesystem::remove(path.substr(0, path.size() - kEnd.size()), ignored);
      std::filesystem::remove(path, ignored);
    }
    close(lock);
  }
}

std::shared_ptr<DdsParticipant> image_writing_participant(const DdsSettings& settings) {
  return make_sharing(settings, kImagesBytes);
}

DdsImageReader::DdsImageReader(EventLoop& loop, const DdsSettings& settings, const TypeMismatchListener& strangers,
                               const TopicInfo& topic, const std::string& channel,
                               std::function<void(const void*)> callback)
    : loop_(loop),
      settings_(settings),
      strangers_(strangers),
      channel_(channel),
      opened_at_(EventLoop::now()),
      heard_at_(opened_at_),
      patience_(kSilence),
      reader_(loop, make_sharing(settings, kReaderBytes), topic, channel,
              [this, callback = std::move(callback)](const void* message) {
                heard_at_ = EventLoop::now();
                patience_ = kSilence;
                callback(message);
              }) {
  loop_.at(opened_at_ + kLook, [this] { look(); });
}

void DdsImageReader::look() {
  const Time now = EventLoop::now();
  loop_.at(now + kLook, [this] { look(); });
  const std::optional<Time> writer_since = strangers_.writer_since(channel_);
  if (!writer_since || heard_at_ > *writer_since) return;
  if (now - std::max(*writer_since, opened_at_) < patience_) return;
  shares_memory_ = !shares_memory_;
  log_dds(fmt::format("topic '{}': nothing comes by {}: listening by {}", channel_,
                      shares_memory_ ? "UDP" : "shared memory", shares_memory_ ? "shared memory" : "UDP"));
  try {
    reader_.move_to(make(settings_, shares_memory_ ? kReaderBytes : 0));
  } catch (const std::runtime_error& error) {
    log_dds(fmt::format("topic '{}': {}", channel_, error.what()));
  }
  opened_at_ = now;
  patience_ = std::min(2 * patience_, kLongestSilence);
}

}  // namespace sidestep
