// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/disturbance_answers.hpp"

#include <algorithm>

#include "common/protocol/senders.hpp"

namespace sidestep {

DisturbanceAnswers::DisturbanceAnswers(Bus& bus, Incarnation incarnation)
    : bus_(bus), incarnation_(incarnation), writer_(bus.advertise(topics::kDisturbanceAnswer)) {}

bool DisturbanceAnswers::repeat(const msg::Disturbance& disturbance) {
  const auto known = std::ranges::find_if(answered_, [&](const Answered& answered) {
    return answered.header == disturbance.header() && answered.answer.robot() == disturbance.robot();
  });
  if (known == answered_.end()) return false;
  writer_.publish(known->answer, bus_.now());
  return true;
}

void DisturbanceAnswers::answer(const msg::Disturbance& disturbance, msg::DisturbanceResult result) {
  msg::DisturbanceAnswer answer;
  answer.simulator(static_cast<std::uint32_t>(Sender::kSimulator));
  answer.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
  answer.header().incarnation(incarnation_);
  answer.robot(disturbance.robot());
  answer.disturbance_incarnation(disturbance.header().incarnation());
  answer.disturbance_number(disturbance.header().message_number());
  answer.result(result);
  writer_.publish(answer, bus_.now());
  if (answered_.size() == kMaxRemembered) answered_.pop_front();
  answered_.push_back({disturbance.header(), answer});
}

}  // namespace sidestep
