// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/histogram_codec.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::histogram_codec_test {

TEST_CASE("a histogram survives encoding and decoding") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  DurationHistogram histogram;
  for (int i = 0; i < 2000; ++i) histogram.add(Duration{static_cast<std::int64_t>(rng.below(3'000'000'000))});
  const msg::DurationCounts message = encode(histogram);
  for (std::size_t i = 0; i < DurationHistogram::kBuckets; ++i)
    CHECK(message.buckets()[i] == histogram.buckets()[i]);
  const DurationHistogram decoded = decode(message);
  CHECK(decoded.buckets() == histogram.buckets());
  CHECK(decoded.count() == histogram.count());
  CHECK(decoded.max() == histogram.max());
}

TEST_CASE("a malicious message decodes to a wrong but harmless histogram") {
  msg::DurationCounts message;
  message.max_ns(~std::uint64_t{0});
  for (auto& bucket : message.buckets()) bucket = ~std::uint32_t{0};
  DurationHistogram histogram = decode(message);
  histogram.merge(histogram);
  CHECK(histogram.quantile(0.5) > Duration{0});
  CHECK(encode(histogram).buckets()[5] == ~std::uint32_t{0});
}

}  // namespace sidestep::histogram_codec_test
