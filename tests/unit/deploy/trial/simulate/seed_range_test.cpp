// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/seed_range.hpp"

#include <utility>

#include "tests/catch.hpp"

namespace sidestep::seed_range_test {

std::pair<std::uint64_t, std::uint64_t> parsed(const std::string& text) {
  const SeedRange seeds = parse_seed_range(text);
  return {seeds.first, seeds.last};
}

TEST_CASE("a range of seeds has a first and a last seed") {
  CHECK(parsed("3..7") == std::pair<std::uint64_t, std::uint64_t>{3, 7});
  CHECK(parsed("0..0") == std::pair<std::uint64_t, std::uint64_t>{0, 0});
  CHECK(parsed("1..1000000") == std::pair<std::uint64_t, std::uint64_t>{1, 1'000'000});
  CHECK(parsed("18446744073709551615..18446744073709551615").first == 18446744073709551615U);
}

TEST_CASE("text that is not a range of seeds and ranges of more than a million seeds are rejected") {
  const auto text = GENERATE("", "1", "1..", "..1", "1..-1", "-1..1", "2..1", "1...2", "1..2 ", " 1..2",
                             "a..b", "1..99999999999999999999");
  CAPTURE(text);
  CHECK_THROWS_WITH(parse_seed_range(text), ContainsSubstring("expected FIRST..LAST"));
  CHECK_THROWS_WITH(parse_seed_range("0..1000000"), ContainsSubstring("at most 1000000 seeds"));
  CHECK_THROWS_WITH(parse_seed_range("0..18446744073709551615"), ContainsSubstring("at most 1000000 seeds"));
}

}  // namespace sidestep::seed_range_test
