// SPDX-License-Identifier: Apache-2.0
#include "vision/league/field_check.hpp"

#include <limits>

#include "tests/catch.hpp"

namespace sidestep::field_check_test {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

league::FieldSize size(double length_m, double width_m) {
  league::FieldSize field;
  field.length_m = length_m;
  field.width_m = width_m;
  return field;
}

TEST_CASE("frames are used once the sender's field is that of the scenario") {
  FieldCheck check({9, 6});
  CHECK_FALSE(check.may_use_frame(kBegin));
  check.on_field(size(9.04, 5.96));
  CHECK(check.may_use_frame(kBegin));
  CHECK_FALSE(check.differs());
}

TEST_CASE("frames of a sender with another field are never used") {
  const league::FieldSize other =
      GENERATE(size(12, 9), size(9, 6.06), size(8.94, 6), size(std::numeric_limits<double>::quiet_NaN(), 6));
  FieldCheck check({9, 6});
  CHECK_FALSE(check.may_use_frame(kBegin));
  check.on_field(other);
  CHECK(check.differs());
  CHECK_FALSE(check.may_use_frame(kBegin + std::chrono::seconds(10)));
  CHECK_THAT(check.problem(), ContainsSubstring("the scenario's is 9 x 6 m"));
}

TEST_CASE("frames of a sender without geometry are used after four seconds") {
  FieldCheck check({9, 6});
  CHECK_FALSE(check.may_use_frame(kBegin));
  CHECK_FALSE(check.may_use_frame(kBegin + FieldCheck::kMaxWait - Duration{1}));
  CHECK(check.may_use_frame(kBegin + FieldCheck::kMaxWait));
}

}  // namespace sidestep::field_check_test
