// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/numbers.hpp"

#include <catch2/catch.hpp>

#include "common/random/rng.hpp"

using namespace sidestep;

TEST_CASE("numbers know which of them is not exceeded by a part however they came in") {
  Rng rng(3);
  Numbers one, parts[2];
  std::vector<double> sorted;
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    const double number = rng.normal();
    one.add(number);
    parts[i % 2].add(number);
    sorted.push_back(number);
    sum += number;
  }
  parts[0].add(parts[1]);
  std::sort(sorted.begin(), sorted.end());
  for (const Numbers* numbers : {&one, &parts[0]}) {
    CHECK(numbers->size() == 200);
    CHECK(numbers->at(0) == sorted.front());
    CHECK(numbers->median() == sorted[100]);
    CHECK(numbers->at(0.95) == sorted[190]);
    CHECK(numbers->at(1) == sorted.back());
    CHECK(numbers->mean() == Approx(sum / 200));
  }
}

TEST_CASE("no numbers are 0") {
  CHECK(Numbers().median() == 0);
  CHECK(Numbers().mean() == 0);
}
