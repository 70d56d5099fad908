// SPDX-License-Identifier: Apache-2.0
// Sends the nearest free robot to each job. If a robot fails to reach its job, the job goes to another robot.
//   sidestep-dispatcher DOMAIN X,Y...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <sidestep/client.hpp>
#include <thread>
#include <vector>

namespace {

using namespace sidestep::client;
using Clock = std::chrono::steady_clock;

/// A job is taken from a robot that has been blocked for this long.
constexpr std::chrono::seconds kPatience{10};
/// All robots are found within this time, which covers DDS discovery and one period of reports.
constexpr std::chrono::milliseconds kDiscovery{2000};

struct Job {
  Goal place;
  std::optional<RobotId> robot{};  ///< the robot that is on its way to the job
  OrderId order = 0;
  std::optional<Clock::time_point> blocked_since{};
  std::set<RobotId> failed{};  ///< robots that failed to reach the job
  bool is_over = false;
};

class Dispatcher {
 public:
  Dispatcher(Client& client, const std::vector<Goal>& places) : client_(client) {
    for (const Goal& place : places) jobs_.push_back({place});
    client_.on_change([this](OrderId, const OrderState&) {
      const std::lock_guard lock(mutex_);
      has_changed_ = true;
      changed_.notify_one();
    });
  }
  ~Dispatcher() { client_.on_change(nullptr); }

  /// Runs until all jobs are over. Returns whether all of them were done.
  bool run() {
    while (!std::all_of(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.is_over; })) {
      for (Job& job : jobs_) follow(job);
      for (Job& job : jobs_) assign(job);
      // Wakes up regularly, because robots may come and go without a change of any order.
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(200), [this] { return has_changed_; });
      has_changed_ = false;
    }
    return are_possible_;
  }

 private:
  void follow(Job& job) {
    if (!job.robot) return;
    const auto state = client_.state(job.order);
    if (!state) return give_up(job, "has lost its order");
    switch (state->phase) {
      case OrderPhase::kArrived:
        say(job, "has arrived");
        return end(job);
      case OrderPhase::kReplaced:
        return give_up(job, "was sent elsewhere");
      case OrderPhase::kRefused:
        if (state->refusal == Refusal::kUnknownRobot) return give_up(job, "is not known");
        say(job, "cannot be sent there: the place is refused");
        are_possible_ = false;
        return end(job);
      case OrderPhase::kBlocked:
        if (!job.blocked_since) job.blocked_since = Clock::now();
        if (Clock::now() - *job.blocked_since < kPatience) return;
        client_.cancel(*job.robot);
        return give_up(job, "is blocked");
      case OrderPhase::kSent:
      case OrderPhase::kAccepted:
      case OrderPhase::kDriving:
        job.blocked_since.reset();
        return;
    }
  }

  static void end(Job& job) {
    job.is_over = true;
    job.robot.reset();
  }

  /// Leaves the job to another robot.
  static void give_up(Job& job, const char* reason) {
    say(job, reason);
    job.failed.insert(*job.robot);
    job.robot.reset();
    job.blocked_since.reset();
  }

  void assign(Job& job) {
    if (job.is_over || job.robot) return;
    const std::vector<Robot> robots = client_.robots();
    const Robot* nearest = nullptr;
    bool have_all_failed = true;
    for (const Robot& robot : robots) {
      if (!robot.is_heard || robot.is_held || job.failed.count(robot.id) > 0) continue;
      have_all_failed = false;
      if (!robot.is_free() || is_busy(robot.id)) continue;
      if (!nearest || distance_m(robot, job) < distance_m(*nearest, job)) nearest = &robot;
    }
    if (have_all_failed) job.failed.clear();  // All robots may try again.
    if (!nearest) return;
    job.robot = nearest->id;
    job.order = client_.go(nearest->id, {job.place});
    say(job, "is sent");
  }

  /// Whether the robot is on its way to another job.
  bool is_busy(RobotId robot) const {
    return std::any_of(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.robot == robot; });
  }

  static double distance_m(const Robot& robot, const Job& job) {
    return std::hypot(robot.pose->x_m - job.place.x_m, robot.pose->y_m - job.place.y_m);
  }

  static void say(const Job& job, const char* what) {
    std::printf("job at %g,%g: robot %u %s\n", job.place.x_m, job.place.y_m, *job.robot, what);
    std::fflush(stdout);
  }

  Client& client_;
  std::vector<Job> jobs_;
  bool are_possible_ = true;
  std::mutex mutex_;  ///< guards has_changed_
  std::condition_variable changed_;
  bool has_changed_ = false;
};

int usage() {
  std::fprintf(stderr, "usage: sidestep-dispatcher DOMAIN X,Y...\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return usage();
  char* end = nullptr;
  const long domain = std::strtol(argv[1], &end, 10);
  if (*argv[1] == '\0' || *end != '\0' || domain < 0 || domain > 232) return usage();
  std::vector<Goal> places;
  for (int i = 2; i < argc; ++i) {
    Goal place;
    int length = 0;
    if (std::sscanf(argv[i], "%lf,%lf%n", &place.x_m, &place.y_m, &length) != 2 || argv[i][length] != '\0' ||
        !std::isfinite(place.x_m) || !std::isfinite(place.y_m))
      return usage();
    places.push_back(place);
  }
  try {
    Settings settings;
    settings.name = "dispatcher";
    settings.domain = static_cast<int>(domain);
    Client client(settings);
    std::this_thread::sleep_for(kDiscovery);
    return Dispatcher(client, places).run() ? 0 : 1;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "sidestep-dispatcher: %s\n", problem.what());
    return 1;
  }
}
