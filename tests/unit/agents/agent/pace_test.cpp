// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/pace.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;

namespace {
constexpr Duration kCycle{16'666'667};
}  // namespace

TEST_CASE("on a fast network one cycle ahead is enough, and a single slow answer changes nothing") {
  Pace pace(kCycle);
  CHECK(pace.lead() == 1);
  for (int i = 0; i < 100; ++i) pace.on_round_trip(i % 20 == 0 ? Duration{40'000'000} : Duration{500'000});
  CHECK(pace.lead() == 1);
}

TEST_CASE("on a slow network an agent looks as far ahead as answers and commands take") {
  Pace pace(kCycle);
  for (int i = 0; i < 20; ++i) pace.on_round_trip(Duration{100'000'000});
  CHECK(pace.lead() == 9);  // 150 ms
  CHECK(pace.patience() == Duration{100'000'000});
  for (int i = 0; i < 20; ++i) pace.on_round_trip(Duration{500'000});
  CHECK(pace.lead() == 1);
  for (int i = 0; i < 20; ++i) pace.on_round_trip(Duration{30'000'000'000});
  CHECK(pace.lead() == 30);
  pace.reset();
  CHECK(pace.lead() == 1);
}

TEST_CASE("what keeps getting lost earns time to ask again, one loss does not") {
  Pace pace(kCycle);
  pace.on_late();
  pace.on_taken();
  pace.on_late();
  CHECK(pace.lead() == 1);
  pace.on_late();
  CHECK(pace.lead() == 2);
  for (int i = 0; i < 100; ++i) pace.on_late();
  const int most = pace.lead();
  CHECK(most < 10);
  for (int i = 0; i < 100; ++i) pace.on_taken();
  CHECK(pace.lead() == 1);
}
