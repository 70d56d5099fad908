// SPDX-License-Identifier: Apache-2.0
#include "vision/league/field_check.hpp"

#include <cmath>
#include <fmt/format.h>

namespace sidestep {

bool FieldCheck::differs() const {
  // The comparisons are false for NaN.
  return sender_ && !(std::abs(sender_->length_m - scenario_.length_m) <= kTolerance_m &&
                      std::abs(sender_->width_m - scenario_.width_m) <= kTolerance_m);
}

bool FieldCheck::may_use_frame(Time now) {
  if (sender_) return !differs();
  if (!first_frame_at_ || now < *first_frame_at_) first_frame_at_ = now;
  return now - *first_frame_at_ >= kMaxWait;
}

std::string FieldCheck::problem() const {
  return fmt::format(
      "the sender's field is {:g} x {:g} m, the scenario's is {:g} x {:g} m: correct the scenario's key "
      "field, or "
      "give --other-field if the fields are to differ",
      sender_->length_m, sender_->width_m, scenario_.length_m, scenario_.width_m);
}

}  // namespace sidestep
