// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_node.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/messaging/course_codec.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/motion/time_to_rest.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {
namespace {

constexpr Duration kStatusPeriod{200'000'000};
/// A course that is delayed by less is not published again.
constexpr Duration kNoticeableDelay{20'000'000};
/// A course is repeated after this time, in case that a message was lost.
constexpr Duration kCoursePeriod{500'000'000};
constexpr int kCyclesBetweenRegistrations = 3;
// Registrations that only measure a clock are less frequent than registrations that ask for another
// coordinator; see FleetReception::kMaxRequestGap.
constexpr Duration kBetweenMeasurements{500'000'000};
// The interval is long, because an agent may have to ask for another coordinator for a long time.
constexpr int kCyclesBetweenRequests = 6;

/// Offset of the robot's cycles from multiples of the cycle time.
Duration cycle_offset(const FloorSpec& floor, RobotId robot) {
  const auto index = std::ranges::count_if(floor.robots, [&](const RobotSpec& r) { return r.id < robot; });
  return floor.cycle * index / static_cast<std::int64_t>(floor.robots.size());
}

/// Returns how long `work` takes. It is measured by the wall clock even if the bus's time is virtual.
template <typename Work>
Duration duration_of(Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::steady_clock::now() - begin;
}

}  // namespace

AgentNode::AgentNode(Bus& bus, const FloorSpec& floor, RobotId robot, Incarnation incarnation,
                     std::shared_ptr<PlanningScratch> scratch)
    : bus_(bus),
      robot_(robot),
      cycle_(floor.cycle),
      max_speed_mps_(floor.limits.speed_mps),
      max_stopping_time_(2 * time_to_rest(floor.limits)),
      agent_(floor, robot, incarnation, std::move(scratch)),
      clocks_(budget_of(floor), floor.margin_m),
      world_(robot),
      event_logger_(events_, robot),
      command_writer_(bus.advertise(topics::kCommand, robot)),
      registration_writer_(bus.advertise(topics::kRegistration)),
      proposal_writer_(bus.advertise(topics::kProposal)),
      status_writer_(bus.advertise(topics::kStatus)),
      course_writer_(bus.advertise(topics::kCourse)),
      offer_writer_(bus.advertise(topics::kCourseOffer)),
      orders_(bus, robot),
      counters_(bus, robot, incarnation, [this](DropCounters& drops) { count_drops(drops); }) {
  if (floor.laser) scans_.emplace(robot, floor.laser->settings);
  subscribe();
  const Time now = robot_now();
  next_cycle_ = now - now.time_since_epoch() % cycle_ + cycle_offset(floor, robot) + cycle_;
  schedule_next_cycle();
  publish_status();
}

void AgentNode::subscribe() {
  bus_.subscribe(topics::kFeedback, robot_, [this](const msg::Feedback& m) { on_robot_report(m); });
  bus_.subscribe(topics::kVerdict, robot_, [this](const msg::Verdict& m) { on_verdict(m); });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& m) { on_world_state(m); });
  bus_.subscribe(topics::kObstacles, [this](const msg::ObstacleList& m) { on_obstacles(m); });
  if (scans_) bus_.subscribe(topics::kScan, robot_, [this](const msg::LaserScan& m) { on_scan(m); });
  bus_.subscribe(topics::kDisturbance, [this](const msg::Disturbance& m) { on_disturbance(m); });
  bus_.subscribe(topics::kLedger, [this](const msg::LedgerPage& m) { on_page(m); });
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& m) { on_coordinator_state(m); });
  bus_.subscribe(topics::kOrderMemory, [this](const msg::OrderMemory& m) { on_orders(m); });
  bus_.subscribe(topics::kSharedCourse, [this](const msg::Course& m) { on_course(m); });
  bus_.subscribe(topics::kSharedCourseOffer, [this](const msg::CourseOffer& m) { on_course_offer(m); });
}

void AgentNode::on_robot_report(const msg::Feedback& message) {
  const auto robot_report = decode(message, robot_, bus_.now());
  if (!accept(robot_report, DropReason::kMalformedFeedback)) return;
  measure_robot_clock(*robot_report);
  const Epoch last_epoch = agent_.epoch();
  const bool was_fenced = agent_.is_fenced();
  const bool is_contradicted = agent_.on_robot_report(*robot_report);
  // Sends the epoch immediately after the robot's first acknowledgement, because no robot moves until all
  // robots have acknowledged the epoch.
  if (!was_fenced && agent_.is_fenced() && agent_.epoch() != 0) publish_command(agent_.command(robot_now()));
  orders_.publish_status(agent_);
  if (robot_report->robot_incarnation == agent_.robot_incarnation())
    event_logger_.on_robot_report(*robot_report);
  if (agent_.epoch() != last_epoch) event_logger_.on_epoch(agent_.epoch(), std::nullopt);
  register_if_due();
  if (is_contradicted) negotiate_if_time();
}

void AgentNode::on_verdict(const msg::Verdict& message) {
  const auto verdict = decode(message, robot_);
  if (!accept(verdict, DropReason::kMalformedVerdict)) return;
  clocks_.on_epoch(agent_.epoch());
  clocks_.on_verdict(*verdict, bus_.now());
  const auto result = agent_.on_verdict(*verdict, robot_now());
  if (result.round_trip) negotiation_durations_.add(*result.round_trip);
  if (result.round_trip && verdict->granted_version == 0) event_logger_.on_denial(*verdict);
  if (result.command) {
    commanded_ = true;
    publish_command(*result.command);
  }
  // Verdicts also answer requests that measure the coordinator's clock.
  if (are_courses_due_ && result.round_trip) plan_courses();
}

void AgentNode::on_world_state(const msg::WorldState& message) {
  WorldObservations world = world_.decode(message);
  // If the robot's clock is beyond the bound, the robot would treat this position as its position at a wrong
  // time.
  if (clocks_.is_beyond_bound(bus_.now())) world.self.reset();
  agent_.on_world_state(world, bus_.now() + clocks_.max_robot_offset(bus_.now()),
                        clocks_.is_robot_known(bus_.now()));
}

void AgentNode::on_obstacles(const msg::ObstacleList& message) {
  const auto list = obstacles_.decode(message);
  if (accept(list, DropReason::kMalformedObstacles))
    agent_.on_obstacles(*list, bus_.now() + clocks_.max_robot_offset(bus_.now()));
}

void AgentNode::on_scan(const msg::LaserScan& message) {
  const auto scan = scans_->decode(message, bus_.now());
  if (accept(scan, DropReason::kMalformedScan))
    agent_.on_scan(*scan, bus_.now() + clocks_.max_robot_offset(bus_.now()));
}

void AgentNode::on_page(const msg::LedgerPage& message) {
  const auto page = ReceivedPage::decode(message, bus_.now(), bus_.attachment(&message));
  if (accept(page, DropReason::kMalformedLedgerPage)) agent_.on_page(*page);
}

void AgentNode::on_coordinator_state(const msg::CoordinatorState& message) {
  const auto heartbeat = decode(message, bus_.now());
  if (!accept(heartbeat, DropReason::kMalformedCoordinatorState)) return;
  const Epoch last_epoch = agent_.epoch();
  const bool could_propose = agent_.may_propose(robot_now());
  agent_.on_coordinator_state(*heartbeat, robot_now());
  if (agent_.epoch() != last_epoch) event_logger_.on_epoch(agent_.epoch(), heartbeat->sender);
  if (agent_.is_superseded()) return;
  // A new epoch is forwarded immediately, because no robot moves until all robots have acknowledged it.
  if (agent_.epoch() != last_epoch) publish_command(agent_.command(robot_now()));
  register_if_due();
  if (!could_propose && agent_.may_propose(robot_now()) && !agent_.has_upcoming_version(robot_now()))
    negotiate_if_time();
}

void AgentNode::on_disturbance(const msg::Disturbance& message) {
  if (message.robot() != robot_ || message.disturbance_kind() != msg::DisturbanceKind::DISTURBANCE_PLACE)
    return;
  const Vec2 position(message.x_m(), message.y_m());
  if (position.allFinite())
    agent_.on_placement(position);
  else
    drops_.count(DropReason::kMalformedPlacement);
}

template <typename Decoded, typename Message>
std::shared_ptr<const Decoded> AgentNode::decode_shared(const Message& message) {
  MessageAttachment* const attachment = bus_.attachment(&message);
  if (attachment) {
    if (auto shared = attachment->get<Decoded>()) return shared;
  }
  auto decoded = decode(message, bus_.now());
  if (!decoded) return nullptr;
  const auto shared = std::make_shared<Decoded>(std::move(*decoded));
  if (attachment) attachment->set(shared);
  return shared;
}

void AgentNode::on_orders(const msg::OrderMemory& message) {
  if (!is_coordinator(message.header().sender())) return;
  const auto page = decode_shared<OrderPage>(message);
  if (!page) return drops_.count(DropReason::kMalformedOrder);
  agent_.on_orders(page);
  if (agent_.is_superseded()) return;
  orders_.on_page(*page, agent_);
  if (agent_.needs_registration() && agent_.coordinator_knows_all_orders()) registration_wait_ = 0;
  register_if_due();
}

void AgentNode::on_course(const msg::Course& message) {
  if (!is_coordinator(message.header().sender())) return;
  auto course = decode_shared<DrivingCourse>(message);
  if (!course) return drops_.count(DropReason::kMalformedCourse);
  agent_.on_course(std::move(course), robot_now());
}

void AgentNode::on_course_offer(const msg::CourseOffer& message) {
  if (!is_coordinator(message.header().sender())) return;
  auto offer = decode_shared<CourseOffer>(message);
  if (!offer) return drops_.count(DropReason::kMalformedCourseOffer);
  agent_.on_course_offer(std::move(offer), robot_now());
}

void AgentNode::begin_cycle() {
  // The estimate of the robot's clock may have changed slightly since the timer was set.
  const Duration early = next_cycle_ - robot_now();
  const Time now = early > Duration{0} && early < cycle_ / 2 ? next_cycle_ : robot_now();
  next_cycle_ = cycle_after(now);
  schedule_next_cycle();
  agent_.close_cycle(now);
  report_changes();
  if (agent_.must_query_robot()) publish_command(agent_.command(now));
  if (agent_.is_superseded()) return;
  agent_.choose_order();
  orders_.confirm_orders(agent_);
  if (!commanded_) publish_command(agent_.command(now));
  commanded_ = false;
  if (registration_wait_ > 0) --registration_wait_;
  register_if_due();
  if (const auto start = agent_.start_to_propose(now, next_cycle_)) negotiate(*start);
}

double AgentNode::speed_limit_mps() const {
  return std::min(max_speed_mps_, clocks_.max_speed_mps(bus_.now()));
}

bool AgentNode::come_to_rest() {
  if (!stopping_since_) stopping_since_ = bus_.now();
  agent_.stop();
  return is_at_rest() || has_elapsed(max_stopping_time_, *stopping_since_);
}

void AgentNode::report_changes() {
  AgentActivity activity = agent_.activity(robot_now());
  const auto offset = clocks_.robot_coordinator_offset(bus_.now());
  if (activity.waits_for == WaitReason::kNone && !clocks_.allows_motion(bus_.now()))
    activity.waits_for = offset ? WaitReason::kClockOutOfBound : WaitReason::kClockNotMeasured;
  event_logger_.update(activity, {speed_limit_mps(), max_speed_mps_, offset}, bus_.now());
}

Time AgentNode::robot_now() const { return bus_.now() + clocks_.robot_offset(); }

// A time in the future was recorded before this process's clock was set back.
bool AgentNode::has_elapsed(Duration period, Time since) const {
  return std::chrono::abs(bus_.now() - since) >= period;
}

Time AgentNode::cycle_after(Time now) const {
  const Duration elapsed = (now - next_cycle_) % cycle_;
  return now - elapsed + (elapsed < Duration{0} ? Duration{0} : cycle_);
}

void AgentNode::measure_robot_clock(const RobotReport& robot_report) {
  clocks_.on_robot_report(robot_report, agent_.incarnation(), bus_.now());
  // If the estimate of the robot's clock has jumped, reschedules the next cycle.
  const Duration until_cycle = next_cycle_ - robot_now();
  if (until_cycle > 2 * cycle_ || until_cycle < -2 * cycle_) next_cycle_ = cycle_after(robot_now());
}

void AgentNode::schedule_next_cycle() {
  bus_.at(next_cycle_ - clocks_.robot_offset(), [this] { begin_cycle(); });
}

void AgentNode::register_if_due() {
  const bool needs_registration = agent_.needs_registration();
  if (!needs_registration && !agent_.needs_other_coordinator(robot_now())) {
    registration_wait_ = 0;
    return;
  }
  if (registration_wait_ > 0) return;
  registration_wait_ = needs_registration ? kCyclesBetweenRegistrations : kCyclesBetweenRequests;
  const bool may_register = agent_.coordinator_knows_all_orders();
  publish(may_register ? agent_.registration() : agent_.epoch_notice());
}

void AgentNode::measure_coordinator_clock(Duration since_last) {
  if (agent_.needs_registration() || !has_elapsed(since_last, measured_at_)) return;
  measured_at_ = bus_.now();
  publish(agent_.registration());
}

bool AgentNode::update_clocks() {
  clocks_.on_epoch(agent_.epoch());
  // The agent repeats the request until a coordinator answers.
  if (clocks_.is_measurement_due(bus_.now())) measure_coordinator_clock(kCyclesBetweenRegistrations * cycle_);
  return clocks_.allows_motion(bus_.now());
}

void AgentNode::negotiate_if_time() {
  if (next_cycle_ - robot_now() > cycle_ / 4) negotiate(agent_.earliest_start(next_cycle_));
}

void AgentNode::negotiate(Time start) {
  if (std::exchange(are_courses_due_, false)) plan_durations_.add(planning_);  // no verdict has come
  if (!agent_.may_propose(robot_now()) || !update_clocks()) return;
  if (const auto rest = agent_.propose_rest_version(robot_now(), start)) return publish_proposal(*rest);
  const double max_speed_mps = clocks_.max_speed_mps(bus_.now());
  const Duration max_lag = clocks_.max_lag(bus_.now());
  std::optional<MotionPlan> plan;
  planning_ = duration_of([&] { plan = agent_.plan(robot_now(), start, max_speed_mps, max_lag); });
  if (!plan) return plan_courses();
  // More measurements narrow the offset's interval, which allows the robot to drive faster.
  if (max_speed_mps < max_speed_mps_) measure_coordinator_clock(kBetweenMeasurements);
  std::optional<Proposal> proposal;
  search_durations_.add(duration_of([&] { proposal = agent_.search(*plan, robot_now()); }));
  if (!proposal) return plan_courses();
  publish_proposal(*proposal);
  are_courses_due_ = true;
}

void AgentNode::plan_courses() {
  are_courses_due_ = false;
  const Time begin = bus_.now();
  planning_ += duration_of([&] { agent_.plan_courses(); });
  agent_.charge_courses(bus_.now() - begin);
  plan_durations_.add(planning_);
  publish_courses();
}

void AgentNode::publish_courses() {
  for (const CourseOffer& offer : agent_.course_offers()) {
    auto message = encode(offer);
    message.header().incarnation(agent_.incarnation());
    offer_writer_.publish(message, bus_.now());
  }
  const DrivingCourse* course = agent_.course();
  const std::optional<Time> plan = course ? std::optional(course->planned_at) : std::nullopt;
  const bool is_new = plan != published_plan_ ||
                      (course && std::chrono::abs(course->start - published_start_) >= kNoticeableDelay);
  // A robot that has arrived is known from its versions.
  const bool is_over = !course || course->end() < robot_now();
  if (!is_new && (is_over || !has_elapsed(kCoursePeriod, course_published_at_))) return;
  DrivingCourse none;
  none.robot = robot_;
  none.planned_at = robot_now();
  auto message = encode(course ? *course : none);
  message.header().incarnation(agent_.incarnation());
  course_writer_.publish(message, bus_.now());
  published_plan_ = plan;
  if (course) published_start_ = course->start;
  course_published_at_ = bus_.now();
}

void AgentNode::publish_command(const Command& command) {
  auto message = encode(command);
  command_writer_.publish(message, bus_.now());
}

void AgentNode::publish(const Registration& registration) {
  auto message = encode(registration);
  agent_.on_request(robot_now());
  registration_writer_.publish(message, bus_.now());
  clocks_.on_request_sent(time_from_ns(message.header().stamp_ns()));
}

void AgentNode::publish_proposal(const Proposal& proposal) {
  auto message = encode(proposal);
  proposal_writer_.publish(message, bus_.now());
  clocks_.on_request_sent(time_from_ns(message.header().stamp_ns()));
}

void AgentNode::count_drops(DropCounters& drops) const {
  drops.add(drops_);
  agent_.count_drops(drops);
  clocks_.count_drops(drops);
  world_.count_drops(drops);
}

void AgentNode::publish_status() {
  bus_.at(bus_.now() + kStatusPeriod, [this] { publish_status(); });
  if (agent_.is_superseded()) return;
  auto status = agent_.status(robot_now());
  status.header().sender(robot_);
  status.header().incarnation(agent_.incarnation());
  clocks_.fill(status, bus_.now());
  status.clock_speed_limit_mps(speed_limit_mps());
  status.negotiation(encode(negotiation_durations_));
  status.plan(encode(plan_durations_));
  status.search(encode(search_durations_));
  status_writer_.publish(status, bus_.now());
}

}  // namespace sidestep
