// SPDX-License-Identifier: Apache-2.0
// Sends a robot back and forth between places.
//   sidestep-patrol DOMAIN ROBOT ROUNDS X,Y X,Y...
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sidestep/client.hpp>
#include <vector>

namespace {

using namespace sidestep::client;

int usage() {
  std::fprintf(stderr, "usage: sidestep-patrol DOMAIN ROBOT ROUNDS X,Y X,Y...\n");
  return 2;
}

/// Parses the whole text as a non-negative number; -1 if it is anything else.
long number_from(const char* text) {
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  return *text != '\0' && *end == '\0' && number >= 0 ? number : -1;
}

/// Drives through the places once. Returns whether the robot has arrived at the last one.
bool drive_round(Client& client, RobotId robot, const std::vector<Goal>& places) {
  const OrderId order = client.go(robot, places);
  std::optional<OrderState> state = client.wait(order, std::chrono::seconds(5));
  if (state && state->phase == OrderPhase::kSent) {
    std::fprintf(stderr, "no coordinator answers on this domain\n");
    return false;
  }
  // A blocked robot continues by itself when it can.
  while (state && !state->is_over) state = client.wait(order, std::chrono::minutes(1));
  if (!state || state->phase == OrderPhase::kRefused)
    std::fprintf(stderr, "the order was refused\n");
  else if (state->phase == OrderPhase::kReplaced)
    std::fprintf(stderr, "another client has sent the robot elsewhere\n");
  return state && state->phase == OrderPhase::kArrived;
}

int patrol(int domain, RobotId robot, long rounds, const std::vector<Goal>& places) {
  Settings settings;
  settings.name = "patrol-" + std::to_string(robot);
  settings.domain = domain;
  Client client(settings);
  for (long round = 1; round <= rounds; ++round) {
    if (!drive_round(client, robot, places)) return 1;
    std::printf("robot %u: round %ld of %ld is done\n", robot, round, rounds);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return usage();
  const long domain = number_from(argv[1]), robot = number_from(argv[2]), rounds = number_from(argv[3]);
  if (domain < 0 || domain > 232 || robot < 0 || robot > 1023 || rounds < 0) return usage();
  std::vector<Goal> places;
  for (int i = 4; i < argc; ++i) {
    Goal place;
    int length = 0;
    if (std::sscanf(argv[i], "%lf,%lf%n", &place.x_m, &place.y_m, &length) != 2 || argv[i][length] != '\0' ||
        !std::isfinite(place.x_m) || !std::isfinite(place.y_m))
      return usage();
    places.push_back(place);
  }
  try {
    return patrol(static_cast<int>(domain), static_cast<RobotId>(robot), rounds, places);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "sidestep-patrol: %s\n", problem.what());
    return 1;
  }
}
