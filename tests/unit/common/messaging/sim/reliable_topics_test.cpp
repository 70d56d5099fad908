// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/common/messaging/reliable_topics.hpp"

#include <memory>
#include <optional>

#include "common/messaging/sim/bus.hpp"

namespace sidestep::sim_reliable_topics_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

class SimRig {
 public:
  SimRig() { run_for(seconds(1)); }

  void start_writer() {
    writer_process_.emplace(network_, SimProcessSpec{writer_id_});
    writer_ = writer_process_->advertise(topics::kAttestation);
  }
  void kill_writer() {
    writer_ = {};
    writer_process_.reset();
  }
  void start_reader() {
    reader_process_.emplace(network_, SimProcessSpec{reader_id_});
    reader_process_->subscribe(topics::kAttestation, [this](const msg::AbsenceAttestation& message) {
      if (message.header().incarnation() == 0)
        ++markers;
      else
        received.push_back(message.header().incarnation());
    });
  }
  void kill_reader() { reader_process_.reset(); }
  void write(std::uint64_t number, std::uint32_t key) {
    msg::AbsenceAttestation message;
    message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    message.robot(key);
    message.header().incarnation(number);
    writer_.publish(message, writer_process_->now());
  }
  void cut() { set_link({0, 1, 0, milliseconds(0), milliseconds(0), milliseconds(0), true}); }
  void heal() { set_link({}); }
  void lose(double fraction) {
    LinkQuality quality;
    quality.loss = fraction;
    set_link(quality);
  }
  void run_for(Duration duration) { network_.run_until(network_.now() + duration); }
  template <typename Condition>
  bool wait_until(Condition condition) {
    for (int left = 6000; left > 0 && !condition(); --left) run_for(milliseconds(5));
    return condition();
  }
  void stop_writer(Duration duration) {
    const Time end = network_.now() + duration;
    writer_process_->at(end - milliseconds(1), [this] { write(1, 0); });
    writer_process_->pause(end, 1000);
    network_.run_until(end);
  }

  std::vector<std::uint64_t> received;
  int markers = 0;

 private:
  void set_link(const LinkQuality& quality) { network_.set_link(writer_id_, reader_id_, quality); }

  SimNetwork network_{1, time_from_ns(1'000'000'000), {}};
  const ProcessId writer_id_ = network_.new_process(), reader_id_ = network_.new_process();
  std::optional<SimBus> writer_process_, reader_process_;
  Writer<msg::AbsenceAttestation> writer_;
};

SIDESTEP_TEST_RELIABLE_TOPICS(SimRig, "on the simulated network")

}  // namespace sidestep::sim_reliable_topics_test
