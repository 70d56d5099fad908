// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/refusal_text.hpp"

namespace sidestep {

const char* refusal_text(msg::OrderResult result) {
  switch (result) {
    case msg::OrderResult::RESULT_UNKNOWN_ROBOT:
      return "the scenario has no such robot";
    case msg::OrderResult::RESULT_OUTSIDE_FIELD:
      return "a goal is outside the field";
    case msg::OrderResult::RESULT_TOO_MANY:
      return "the coordinator cannot remember more holds or zones";
    case msg::OrderResult::RESULT_REMEMBERED:
    case msg::OrderResult::RESULT_REPLACED:
    case msg::OrderResult::RESULT_MALFORMED:
      break;
  }
  return "the coordinator considers it malformed";
}

}  // namespace sidestep
