// SPDX-License-Identifier: Apache-2.0
#include "common/league/refusal.hpp"

namespace sidestep::league {

std::string_view in_words(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      return "nothing is wrong";
    case Refusal::kTooLong:
      return "it is longer than a datagram can be";
    case Refusal::kMalformed:
      return "it is not of the message's type or lacks a field";
    case Refusal::kEmpty:
      return "it says nothing";
    case Refusal::kTooMany:
      return "it has more elements of one kind than make sense";
    case Refusal::kNumber:
      return "a number is not finite or out of range";
    case Refusal::kCamera:
      return "a camera's number is out of range";
    case Refusal::kRobot:
      return "a robot's number or team is out of range";
    case Refusal::kTime:
      return "a time is not finite or out of range";
    case Refusal::kText:
      return "a text is too long";
  }
  return "?";
}

}  // namespace sidestep::league
