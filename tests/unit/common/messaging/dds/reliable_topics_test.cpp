// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/common/messaging/reliable_topics.hpp"

#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "common/messaging/impairment.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::dds_reliable_topics_test {

using std::chrono::milliseconds;

struct Request {
  std::uint64_t number = 0;
  std::uint32_t key = 0;
};

TEST_CASE("publishes reliable messages on request", "[.reliable_writer][slow]") {
  REQUIRE(signal(SIGTERM, SIG_DFL) != SIG_ERR);
  DdsSettings settings = test_settings("writer");
  settings.domain = std::atoi(std::getenv("SIDESTEP_TEST_DOMAIN"));
  DdsBus bus(settings);
  auto writer = bus.advertise(topics::kAttestation);
  bus.watch(STDIN_FILENO, [&] {
    Request request;
    if (read(STDIN_FILENO, &request, sizeof request) != sizeof request) return bus.stop();
    msg::AbsenceAttestation message;
    message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    message.robot(request.key);
    message.header().incarnation(request.number);
    writer.publish(message, bus.now());
    const char done = 0;
    if (write(STDOUT_FILENO, &done, 1) != 1) bus.stop();
  });
  bus.run();
}

/// A child process that publishes what the test requests, until it is killed.
class WriterProcess {
 public:
  WriterProcess() {
    setenv("SIDESTEP_TEST_DOMAIN", std::to_string(test_settings().domain).c_str(), 1);
    int to_child[2], from_child[2];
    REQUIRE(pipe(to_child) == 0);
    REQUIRE(pipe(from_child) == 0);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(to_child[0], STDIN_FILENO);
      dup2(from_child[1], STDOUT_FILENO);
      for (const int end : {to_child[0], to_child[1], from_child[0], from_child[1]}) close(end);
      execl("/proc/self/exe", "reliable_writer", "[.reliable_writer]", "--out", "/dev/null", nullptr);
      _exit(127);
    }
    REQUIRE(pid_ > 0);
    close(to_child[0]);
    close(from_child[1]);
    requests_ = to_child[1];
    answers_ = from_child[0];
  }
  ~WriterProcess() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    close(requests_);
    close(answers_);
  }
  WriterProcess(const WriterProcess&) = delete;
  WriterProcess& operator=(const WriterProcess&) = delete;

  void request(std::uint64_t number, std::uint32_t key) {
    const Request request{number, key};
    REQUIRE(::write(requests_, &request, sizeof request) == sizeof request);
  }
  void wait_for_answer() {
    char done = 0;
    REQUIRE(read(answers_, &done, 1) == 1);
  }
  void send(int signal) { REQUIRE(kill(pid_, signal) == 0); }

 private:
  pid_t pid_ = 0;
  int requests_ = 0, answers_ = 0;
};

class DdsRig {
 public:
  void start_writer() { writer_.emplace(); }
  void kill_writer() { writer_.reset(); }
  void start_reader() {
    DdsSettings settings = test_settings("reader");
    settings.faults = true;
    reader_ = std::make_unique<DdsBus>(settings);
    reader_->subscribe(topics::kAttestation, [this](const msg::AbsenceAttestation& message) {
      if (message.header().incarnation() == 0)
        ++markers;
      else
        received.push_back(message.header().incarnation());
    });
  }
  void kill_reader() { reader_.reset(); }
  void write(std::uint64_t number, std::uint32_t key) {
    writer_->request(number, key);
    writer_->wait_for_answer();
  }
  void cut() {
    LinkQuality quality = kUnimpairedLink;
    quality.is_cut = true;
    reader_->impair(quality, 1);
  }
  void heal() { reader_->impair(kUnimpairedLink, 1); }
  void lose(double fraction) {
    LinkQuality quality = kUnimpairedLink;
    quality.loss = fraction;
    reader_->impair(quality, 1);
  }
  void run_for(Duration duration) {
    if (reader_)
      reader_->run_until(reader_->now() + duration);
    else
      std::this_thread::sleep_for(duration);
  }
  template <typename Condition>
  bool wait_until(Condition condition) {
    const Time deadline = EventLoop::now() + kDeadline;
    while (!condition() && EventLoop::now() < deadline) reader_->run_until(reader_->now() + kPause);
    return condition();
  }
  void stop_writer(Duration duration) {
    writer_->send(SIGSTOP);
    writer_->request(1, 0);
    run_for(duration);
    writer_->send(SIGCONT);
    writer_->wait_for_answer();
  }

  std::vector<std::uint64_t> received;
  int markers = 0;

 private:
  static constexpr Duration kPause = milliseconds(20);

  std::optional<WriterProcess> writer_;
  std::unique_ptr<DdsBus> reader_;
};

SIDESTEP_TEST_RELIABLE_TOPICS(DdsRig, "over DDS")

}  // namespace sidestep::dds_reliable_topics_test
