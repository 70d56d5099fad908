// SPDX-License-Identifier: Apache-2.0
#include "common/league/decode_error.hpp"

namespace sidestep::league {

std::string_view describe(DecodeError error) {
  switch (error) {
    case DecodeError::kNone:
      return "no error";
    case DecodeError::kTooLong:
      return "it is longer than a UDP datagram";
    case DecodeError::kMalformed:
      return "it is not a message of this type, or a required field is missing";
    case DecodeError::kEmpty:
      return "it is empty";
    case DecodeError::kTooMany:
      return "it has too many elements of one kind";
    case DecodeError::kNumber:
      return "a number is not finite or out of range";
    case DecodeError::kCamera:
      return "a camera id is out of range";
    case DecodeError::kRobot:
      return "a robot id or team is out of range";
    case DecodeError::kTime:
      return "a time is not finite or out of range";
    case DecodeError::kText:
      return "a text is too long";
    case DecodeError::kCommand:
      return "a command of the referee is unknown";
  }
  return "?";
}

}  // namespace sidestep::league
