// SPDX-License-Identifier: Apache-2.0
// Messages with random bytes: every value that a codec accepts must be within bounds.
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/random_messages.hpp"

namespace sidestep::corrupted_messages_test {

using namespace random_messages;

/// Eight bytes that a hostile sender might choose.
std::uint64_t hostile_eight_bytes(Rng& rng) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kNumbers{std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity, 1e300, -1.0};
  constexpr std::uint64_t kLowest = std::uint64_t{1} << 63;  // the lowest signed number
  switch (rng.below(4)) {
    case 0:
      return std::bit_cast<std::uint64_t>(kNumbers[rng.below(kNumbers.size())]);
    case 1:
      return rng.chance(0.5) ? kLowest : kLowest - 1;
    case 2:
      return rng.below(20);
    default:
      return rng.bits();
  }
}

/// The message with some of its bytes replaced; nullopt if a bus would not deliver it.
template <typename Message>
std::optional<Message> corrupted(const Topic<Message>& topic, const Message& original, Rng& rng) {
  std::vector<std::uint8_t> bytes;
  append_cdr(topic, &original, bytes);
  for (std::uint64_t changes = 1 + rng.below(3); changes > 0; --changes) {
    if (rng.chance(0.5)) {
      bytes[rng.below(bytes.size())] = static_cast<std::uint8_t>(rng.bits());
      continue;
    }
    // The position is a multiple of eight, because messages align eight-byte numbers.
    const std::uint64_t word = hostile_eight_bytes(rng), begin = 8 * rng.below(bytes.size() / 8);
    for (std::size_t i = 0; i < 8; ++i) bytes[begin + i] = static_cast<std::uint8_t>(word >> (8 * i));
  }
  std::optional<Message> message;
  const auto keep = [&](const void* read) { message = *static_cast<const Message*>(read); };
  return read_cdr(topic, bytes, keep) ? message : std::nullopt;
}

/// Decodes corrupted messages, and requires that all accepted values are within bounds.
template <typename Message, typename Generate, typename Decode, typename Check>
void check_corrupted(const Topic<Message>& topic, Generate generate, Decode decode_message, Check is_valid) {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  int accepted = 0, refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto message = corrupted(topic, generate(rng), rng);
    if (!message) continue;
    const auto value = decode_message(*message);
    if (value && !is_valid(*value)) FAIL("message " << i << " is out of bounds");
    ++(value ? accepted : refused);
  }
  CHECK(accepted > 1000);
  CHECK(refused > 100);
}

bool is_within(const Vec2& v, double bound) { return v.cwiseAbs().maxCoeff() <= bound; }
bool is_within(double value, double low, double high) { return value >= low && value <= high; }
bool is_within(Time time) { return to_ns(time) >= 0 && time < kNow + std::chrono::hours(1); }
bool is_within(std::uint64_t number) {
  return number < static_cast<std::uint64_t>(to_ns(kNow + std::chrono::hours(1)));
}

bool is_valid_phase(const MotionPhase& phase) {
  return phase.duration >= Duration{0} && phase.duration <= std::chrono::minutes(1) &&
         is_within(phase.acceleration_mps2, 1e3);
}

bool is_valid_version(const Version& version, RobotId robot = kRobot) {
  const Trajectory& trajectory = version.trajectory;
  const auto& intent = version.intent;
  const bool is_valid_intent =
      !intent || (is_within(intent->velocity_mps, 100) && is_within(intent->velocity_duration_s, 0, 60) &&
                  is_within(intent->waypoint_m, 1e4) && is_within(intent->goal_m, 1e4));
  return version.robot == robot && is_within(version.incarnation) && is_within(version.number) &&
         is_within(version.base) && is_within(trajectory.start()) &&
         is_within(trajectory.at_start().position_m, 1e4) &&
         is_within(trajectory.at_start().velocity_mps, 100) && is_within(version.inflation_m, 0, 10) &&
         std::ranges::all_of(trajectory.phases(), is_valid_phase) && is_valid_intent;
}

TEST_CASE("a command with random bytes is refused or within bounds") {
  check_corrupted(
      topics::kCommand, [](Rng& rng) { return message_of(random_command(rng)); },
      [](const msg::Command& message) { return decode(message, kRobot, kNow); },
      [](const Command& command) {
        const auto& version = command.version;
        const bool is_valid_number =
            !version || (version->number > 0 && version->incarnation <= command.incarnation);
        const bool is_valid_fix = !command.fix || (is_within(command.fix->position_m, 1e4) &&
                                                   std::isfinite(command.fix->heading_rad));
        return command.robot == kRobot && command.incarnation > 0 && is_within(command.incarnation) &&
               is_within(command.epoch) && is_within(command.sent_at) &&
               std::isfinite(command.desired_heading_rad) && (!version || is_valid_version(*version)) &&
               is_valid_number && is_valid_fix;
      });
}

TEST_CASE("feedback with random bytes is refused or within bounds") {
  constexpr double kMax = std::numeric_limits<double>::max();
  check_corrupted(
      topics::kFeedback, [](Rng& rng) { return message_of(random_robot_report(rng)); },
      [](const msg::Feedback& message) { return decode(message, kRobot, kNow); },
      [](const RobotReport& f) {
        const bool is_valid_echo =
            !f.command || (is_within(f.command->sent_at) && is_within(f.command->received_at));
        return f.robot == kRobot && is_within(f.robot_incarnation) && is_within(f.obeyed_incarnation) &&
               is_within(f.obeyed_epoch) && is_within(f.valid_at) && is_valid_version(f.executing) &&
               is_valid_echo && f.estimate.position_m.allFinite() && f.estimate.velocity_mps.allFinite() &&
               std::isfinite(f.heading_rad) && is_within(f.tracking_error_m, 0, kMax) &&
               is_within(f.uncertainty.position_error_rms_m, 0, kMax) &&
               is_within(f.uncertainty.odometry_scale_stddev, 0, kMax);
      });
}

TEST_CASE("a proposal with random bytes is refused or its candidates are malformed or within bounds") {
  int malformed = 0;
  check_corrupted(
      topics::kProposal, [](Rng& rng) { return message_of(random_proposal(rng)); },
      [](const msg::Proposal& message) { return decode(message, kNow); },
      [&](const Proposal& proposal) {
        if (proposal.robot >= kMaxRobots || proposal.candidate_count > msg::MAX_CANDIDATES) return false;
        const Version* first = nullptr;
        for (std::size_t i = 0; i < proposal.candidate_count; ++i) {
          const auto& candidate = proposal.candidates[i];
          malformed += !candidate;
          if (!candidate) continue;
          if (!first) first = &*candidate;
          if (!is_valid_version(*candidate, proposal.robot) || candidate->base != first->base ||
              candidate->trajectory.start() != first->trajectory.start())
            return false;
        }
        return true;
      });
  CHECK(malformed > 1000);
}

TEST_CASE("a registration with random bytes is refused or its versions are malformed or within bounds") {
  int malformed = 0;
  check_corrupted(
      topics::kRegistration, [](Rng& rng) { return message_of(random_registration(rng)); },
      [](const msg::Registration& message) { return decode(message, kNow); },
      [&](const Registration& registration) {
        malformed += !registration.versions;
        const auto is_valid = [&](const Version& version) {
          return is_valid_version(version, registration.robot);
        };
        return registration.robot < kMaxRobots &&
               (!registration.versions || std::ranges::all_of(registration.versions->versions(), is_valid));
      });
  CHECK(malformed > 1000);
}

bool is_valid_course(const DrivingCourse& course) {
  const std::vector<State>& states = course.states;
  const auto is_valid = [](const State& state) {
    return is_within(state.position_m, 1e4) && is_within(state.velocity_mps, 100);
  };
  const bool is_continuous = std::ranges::adjacent_find(states, [](const State& a, const State& b) {
                               return (b.position_m - a.position_m).norm() > 5;
                             }) == states.end();
  return course.robot < kMaxRobots && course.planned_at > Time{} && is_within(course.planned_at) &&
         is_within(course.due) && is_within(course.start) && states.size() <= msg::MAX_COURSE_POINTS &&
         std::ranges::all_of(states, is_valid) && is_continuous &&
         (states.empty() || states.back().velocity_mps.isZero(0));
}

TEST_CASE("a course with random bytes is refused or within bounds") {
  check_corrupted(
      topics::kCourse, [](Rng& rng) { return encode(random_course(rng, 1 + rng.below(8))); },
      [](const msg::Course& message) { return decode(message, kNow); }, is_valid_course);
}

TEST_CASE("an offer of a course with random bytes is refused or within bounds") {
  check_corrupted(
      topics::kCourseOffer,
      [](Rng& rng) {
        return encode(CourseOffer{random_course(rng, 1 + rng.below(8)), random_time(rng),
                                  static_cast<RobotId>(rng.below(kMaxRobots))});
      },
      [](const msg::CourseOffer& message) { return decode(message, kNow); },
      [](const CourseOffer& offer) {
        return is_valid_course(offer.course) && !offer.course.is_empty() && is_within(offer.replaces) &&
               offer.by < kMaxRobots;
      });
}

TEST_CASE("a verdict with random bytes is refused or has known reasons") {
  check_corrupted(
      topics::kVerdict, [](Rng& rng) { return message_of(random_verdict(rng)); },
      [](const msg::Verdict& message) { return decode(message, kRobot); },
      [](const Verdict& verdict) {
        return verdict.robot == kRobot && std::ranges::all_of(verdict.reasons, [](msg::Reason reason) {
                 return reason <= msg::Reason::REASON_HELD;
               });
      });
}

TEST_CASE("a coordinator state with random bytes is refused or has a plausible epoch and a known mode") {
  check_corrupted(
      topics::kCoordinator,
      [](Rng& rng) {
        msg::CoordinatorState message;
        message.header().sender(10000);
        message.epoch(rng.below(1'000'000'000'000'000));
        msg::RobotNotice missing, displaced;
        missing.is_missing(true);
        displaced.robot(3);
        displaced.is_displaced(true);
        message.notices({missing, displaced});
        return message;
      },
      [](const msg::CoordinatorState& message) { return decode(message, kNow); },
      [](const CoordinatorHeartbeat& heartbeat) {
        return is_within(heartbeat.epoch) && static_cast<std::uint32_t>(heartbeat.mode) <= 2 &&
               heartbeat.notices.size() <= kMaxRobots &&
               std::ranges::all_of(heartbeat.notices, [](const msg::RobotNotice& notice) {
                 return notice.robot() < kMaxRobots &&
                        (!notice.is_displaced() || std::isfinite(notice.x_m()));
               });
      });
}

Order random_order(Rng& rng) {
  Order order{static_cast<msg::OrderKind>(rng.below(6)), static_cast<RobotId>(rng.below(30)),
              static_cast<ClientId>(Sender::kOperator),
              static_cast<OrderNumber>(to_ns(kNow)) - rng.below(1'000'000'000)};
  if (order.kind >= msg::OrderKind::ORDER_ZONE) order.robot = kAllRobots;
  const std::uint64_t count = 1 + rng.below(4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec2 place(rng.uniform(-9, 9), rng.uniform(-9, 9));
    if (order.kind == msg::OrderKind::ORDER_GO) order.goals.push_back({place, rng.uniform(-3, 3), 1.5, 0.1});
    if (order.kind == msg::OrderKind::ORDER_ZONE) order.zone.corners_m.push_back(place);
  }
  return order;
}

bool is_within(const Order& order) {
  const auto is_goal = [](const Goal& goal) {
    return is_within(goal.position_m, 1e4) && is_within(goal.heading_rad.value_or(0), -100, 100) &&
           is_within(goal.speed_limit_mps.value_or(1), 0.01, 100) &&
           is_within(goal.tolerance_m.value_or(1), 0.001, 10);
  };
  const auto is_corner = [](const Vec2& corner) { return is_within(corner, 1e4); };
  return static_cast<std::uint32_t>(order.kind) <= 5 && order.number > 0 && is_within(order.number) &&
         order.goals.size() <= msg::MAX_ORDER_POSES && std::ranges::all_of(order.goals, is_goal) &&
         order.zone.corners_m.size() <= 16 && std::ranges::all_of(order.zone.corners_m, is_corner) &&
         is_within(order.zone.radius_m, 0, 1e4) &&
         (order.kind != msg::OrderKind::ORDER_ZONE || !order.zone.corners_m.empty());
}

TEST_CASE("an order with random bytes is refused or within bounds") {
  check_corrupted(
      topics::kOrder, [](Rng& rng) { return encode(random_order(rng)); },
      [](const msg::Order& message) { return decode(message, kNow); },
      [](const Order& order) {
        return is_within(order) && (order.kind != msg::OrderKind::ORDER_GO || !order.goals.empty());
      });
}

TEST_CASE("a page of remembered orders with random bytes is refused or within bounds") {
  check_corrupted(
      topics::kOrderMemory,
      [](Rng& rng) {
        std::vector<RememberedOrder> orders;
        for (std::uint64_t i = rng.below(8); i > 0; --i)
          orders.push_back({random_order(rng), {msg::OrderState::ORDER_DRIVING, rng.below(3)}});
        msg::OrderMemory message = encode(orders, true, false).front();
        const auto process = static_cast<std::uint32_t>(rng.below(30));
        message.process(process);
        message.header().sender(process);
        return message;
      },
      [](const msg::OrderMemory& message) { return decode(message, kNow); },
      [](const OrderPage& page) {
        return page.orders.size() <= msg::MAX_MEMORY_ORDERS && page.index < std::max(1U, page.count) &&
               std::ranges::all_of(page.orders, [](const RememberedOrder& remembered) {
                 return is_within(remembered.order) &&
                        static_cast<std::uint32_t>(remembered.progress.state) <= 4;
               });
      });
}

}  // namespace sidestep::corrupted_messages_test
