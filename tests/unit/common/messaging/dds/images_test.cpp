// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/images.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sched.h>
#include <set>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/sanitized.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::images_test {

constexpr std::size_t kUsualBytes = 780 * 580 * 2;
// Without shared memory, a reader built with a sanitizer is too slow for larger bursts of datagrams.
constexpr std::size_t kLargestBytes = kIsSanitized ? 2 * kUsualBytes : 2448 * 2048 * 3;

/// An image in which every byte depends on the image's number.
msg::CameraImage numbered_image(std::uint32_t camera, int number, std::size_t bytes) {
  msg::CameraImage image;
  image.camera(camera);
  image.captured_at_ns(number);
  image.pixels().resize(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    image.pixels()[i] = static_cast<std::uint8_t>(i * 31 + i / 251 + static_cast<std::size_t>(number));
  return image;
}

/// Receives images and counts images that differ from the sent images.
struct Watcher {
  Watcher(const DdsSettings& settings, std::size_t bytes) : bus(settings), expected_bytes(bytes) {
    bus.subscribe<msg::CameraImage>(topics::kImages, [this](const msg::CameraImage& image) {
      cameras.insert(image.camera());
      ++count;
      const auto number = static_cast<int>(image.captured_at_ns());
      wrong += image.pixels() != numbered_image(image.camera(), number, expected_bytes).pixels();
    });
  }
  DdsBus bus;
  std::size_t expected_bytes;
  std::set<std::uint32_t> cameras;
  int count = 0, wrong = 0;
};

DdsSettings settings_of(const std::string& name, bool faults) {
  DdsSettings settings = test_settings(name);
  settings.faults = faults;
  return settings;
}

/// Sends images of two cameras at 100 Hz until the process ends.
void send(DdsBus& bus, Writer<msg::CameraImage>& writer, std::size_t bytes, int number) {
  msg::CameraImage image = numbered_image(static_cast<std::uint32_t>(number % 2), number, bytes);
  writer.publish(image, bus.now());
  bus.at(bus.now() + Duration{10'000'000},
         [&bus, &writer, bytes, number] { send(bus, writer, bytes, number + 1); });
}

TEST_CASE("images of any size arrive unchanged, with and without shared memory") {
  const bool writer_shares = GENERATE(true, false), reader_shares = GENERATE(true, false);
  const std::size_t bytes = GENERATE(std::size_t{0}, kUsualBytes, kLargestBytes);
  CAPTURE(writer_shares, reader_shares, bytes);
  Watcher watcher(settings_of("watcher", !reader_shares), bytes);
  DdsBus camera(settings_of("camera", !writer_shares));
  Writer<msg::CameraImage> writer = camera.advertise(topics::kImages);
  send(camera, writer, bytes, 0);
  CHECK(run_until([&] { return watcher.cameras.size() == 2 && watcher.count >= 4; }, camera, watcher.bus));
  CHECK(watcher.wrong == 0);
}

TEST_CASE("camera process", "[.camera][slow]") {
  if (std::getenv("SIDESTEP_TEST_OWN_MEMORY")) {
    REQUIRE(unshare(CLONE_NEWNS) == 0);
    REQUIRE(mount("", "/", "", MS_REC | MS_PRIVATE, "") == 0);
    REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", 0, "size=64m") == 0);
  }
  DdsSettings settings;
  settings.domain = std::stoi(std::getenv("SIDESTEP_TEST_DOMAIN"));
  DdsBus bus(settings);
  Writer<msg::CameraImage> writer = bus.advertise(topics::kImages);
  send(bus, writer, kUsualBytes, 0);
  const pid_t parent = getppid();
  while (getppid() == parent) bus.run_until(bus.now() + kStep);
}

/// Runs the camera process until it is destroyed.
class Camera {
 public:
  explicit Camera(bool has_own_memory) {
    setenv("SIDESTEP_TEST_DOMAIN", std::to_string(test_settings().domain).c_str(), 1);
    has_own_memory ? setenv("SIDESTEP_TEST_OWN_MEMORY", "1", 1) : unsetenv("SIDESTEP_TEST_OWN_MEMORY");
    process_ = fork();
    if (process_ != 0) return;
    execl("/proc/self/exe", "camera", "[.camera]", nullptr);
    _exit(127);
  }
  ~Camera() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

 private:
  pid_t process_;
};

TEST_CASE("images arrive at a reader that does not share memory with the writer") {
  SIDESTEP_NEEDS_ROOT();
  Watcher watcher(test_settings("watcher"), kUsualBytes);
  const Camera camera(true);
  CHECK(run_until([&] { return watcher.count >= 4; }, watcher.bus));
  CHECK(watcher.wrong == 0);
}

TEST_CASE("only the shared memory of killed processes is removed") {
  const auto folder = std::filesystem::temp_directory_path() / ("sidestep-shm-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto path = [&](const std::string& name) { return (folder / name).string(); };
  for (const char* name : {"fastrtps_0a", "fastrtps_0a_el", "fastrtps_0b", "fastrtps_0b_el", "other",
                           "other_el", "fastrtps_port7410"})
    std::ofstream(path(name)) << "x";
  const int held = open(path("fastrtps_0b_el").c_str(), O_RDONLY);
  REQUIRE(flock(held, LOCK_EX | LOCK_NB) == 0);
  const auto count = [&] {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  };
  remove_stale_segments(folder, std::chrono::hours(1));
  CHECK(count() == 7);
  remove_stale_segments(folder, std::chrono::seconds(0));
  CHECK(count() == 5);
  CHECK_FALSE(std::filesystem::exists(path("fastrtps_0a")));
  CHECK_FALSE(std::filesystem::exists(path("fastrtps_0a_el")));
  close(held);
  remove_stale_segments(folder, std::chrono::seconds(0));
  CHECK(count() == 3);
  remove_stale_segments(folder / "none", std::chrono::seconds(0));
  std::filesystem::remove_all(folder);
}

TEST_CASE("after a camera process is killed, its successor's images arrive") {
  Watcher watcher(test_settings("watcher"), kUsualBytes);
  for (int run = 0; run < 3; ++run) {
    CAPTURE(run);
    watcher.count = 0;
    const Camera camera(false);
    CHECK(run_until([&] { return watcher.count >= 4; }, watcher.bus));
  }
  CHECK(watcher.wrong == 0);
}

}  // namespace sidestep::images_test
