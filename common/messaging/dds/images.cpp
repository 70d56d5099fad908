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

constexpr Duration kMinSilenceTimeout{1'000'000'000}, kMaxSilenceTimeout{16'000'000'000};
constexpr std::uint32_t kImagesBytes = 32 << 20;   ///< memory for all images that wait to be read
constexpr std::uint32_t kReaderBytes = 1 << 18;    ///< memory of a reader, which sends little
constexpr std::chrono::seconds kCreationGrace{5};  ///< a newer segment may not be locked yet
constexpr Duration kCheckPeriod{250'000'000};

std::shared_ptr<DdsParticipant> make_participant(const DdsSettings& settings,
                                                 std::uint32_t shared_memory_bytes) {
  DdsSettings named = settings;
  named.participant += "-images";
  return std::make_shared<DdsParticipant>(named, nullptr, shared_memory_bytes);
}

std::shared_ptr<DdsParticipant> make_sharing_participant(const DdsSettings& settings, std::uint32_t bytes) {
  remove_stale_segments("/dev/shm", kCreationGrace);
  try {
    return make_participant(settings, bytes);
  } catch (const std::runtime_error&) {
    auto participant = make_participant(settings, 0);
    log_dds("no shared memory: images are sent over UDP");
    return participant;
  }
}

}  // namespace

void remove_stale_segments(const std::filesystem::path& folder, std::chrono::seconds min_age) {
  constexpr std::string_view kBegin = "fastrtps_", kEnd = "_el";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) continue;
    const int lock = open(entry.path().c_str(), O_RDONLY);
    if (lock < 0) continue;
    struct stat status {};
    const bool is_old = fstat(lock, &status) == 0 && std::time(nullptr) - status.st_ctime >= min_age.count();
    if (is_old && flock(lock, LOCK_EX | LOCK_NB) == 0) {
      const std::string path = entry.path().string();
      std::filesystem::remove(path.substr(0, path.size() - kEnd.size()), ignored);
      std::filesystem::remove(path, ignored);
    }
    close(lock);
  }
}

std::shared_ptr<DdsParticipant> image_publisher_participant(const DdsSettings& settings) {
  return make_sharing_participant(settings, kImagesBytes);
}

DdsImageReader::DdsImageReader(EventLoop& loop, const DdsSettings& settings,
                               const TypeMismatchListener& type_mismatches, const TopicInfo& topic,
                               const std::string& channel, std::function<void(const void*)> callback)
    : loop_(loop),
      settings_(settings),
      type_mismatches_(type_mismatches),
      channel_(channel),
      opened_at_(EventLoop::now()),
      last_received_(opened_at_),
      silence_timeout_(kMinSilenceTimeout),
      reader_(loop, make_sharing_participant(settings, kReaderBytes), topic, channel,
              [this, callback = std::move(callback)](const void* message) {
                last_received_ = EventLoop::now();
                silence_timeout_ = kMinSilenceTimeout;
                callback(message);
              }) {
  loop_.at(opened_at_ + kCheckPeriod, [this] { check_silence(); });
}

void DdsImageReader::check_silence() {
  const Time now = EventLoop::now();
  loop_.at(now + kCheckPeriod, [this] { check_silence(); });
  const std::optional<Time> latest_writer_found_at = type_mismatches_.latest_writer_found_at(channel_);
  if (!latest_writer_found_at || last_received_ > *latest_writer_found_at) return;
  if (now - std::max(*latest_writer_found_at, opened_at_) < silence_timeout_) return;
  shares_memory_ = !shares_memory_;
  log_dds(fmt::format("topic '{}': nothing received over {}, switching to {}", channel_,
                      shares_memory_ ? "UDP" : "shared memory", shares_memory_ ? "shared memory" : "UDP"));
  try {
    reader_.move_to(make_participant(settings_, shares_memory_ ? kReaderBytes : 0));
  } catch (const std::runtime_error& error) {
    log_dds(fmt::format("topic '{}': {}", channel_, error.what()));
  }
  opened_at_ = now;
  silence_timeout_ = std::min(2 * silence_timeout_, kMaxSilenceTimeout);
}

}  // namespace sidestep
