// SPDX-License-Identifier: Apache-2.0
#include "common/client/disturbance_client.hpp"

#include <utility>

#include "common/messaging/disturbance_answer.hpp"
#include "common/messaging/operator_header.hpp"

namespace sidestep {

DisturbanceClient::DisturbanceClient(Bus& bus, RawWriter& writer)
    : bus_(bus), writer_(writer), begun_(bus.now()) {
  bus_.subscribe(topics::kDisturbanceAnswer,
                 [this](const msg::DisturbanceAnswer& answer) { on_answer(answer); });
  bus_.at(bus_.now() + kRepetitionPeriod, [this] { repeat(); });
}

void DisturbanceClient::send(msg::Disturbance disturbance, OnResult on_result) {
  const Time now = bus_.now();
  disturbance.header(operator_header(begun_, ++count_, now));
  sent_.push_back({std::move(disturbance), now, std::move(on_result)});
  writer_.write(&sent_.back().disturbance);
}

void DisturbanceClient::give_up() {
  std::list<Sent> given_up;
  given_up.swap(sent_);
  report(given_up, std::nullopt);
}

void DisturbanceClient::repeat() {
  const Time now = bus_.now();
  bus_.at(now + kRepetitionPeriod, [this] { repeat(); });
  std::list<Sent> given_up;
  while (!sent_.empty() && now - sent_.front().sent_at >= kTimeout)
    given_up.splice(given_up.end(), sent_, sent_.begin());
  for (const Sent& sent : sent_)
    if (now - sent.sent_at >= kRepetitionPeriod) writer_.write(&sent.disturbance);
  report(given_up, std::nullopt);
}

void DisturbanceClient::on_answer(const msg::DisturbanceAnswer& answer) {
  for (auto sent = sent_.begin(); sent != sent_.end(); ++sent) {
    const auto result = result_in(answer, sent->disturbance);
    if (!result) continue;
    std::list<Sent> answered;
    answered.splice(answered.end(), sent_, sent);
    return report(answered, result);
  }
}

void DisturbanceClient::report(std::list<Sent>& finished,
                               const std::optional<msg::DisturbanceResult>& result) {
  for (const Sent& sent : finished) sent.on_result(result);
}

}  // namespace sidestep
