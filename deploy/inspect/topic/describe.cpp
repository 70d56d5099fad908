// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/describe.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "common/messaging/histogram_codec.hpp"
#include "common/messaging/message_schema.hpp"
#include "common/protocol/drop_reasons.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/inspect/topic/idl/idl_decoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "deploy/inspect/topic/idl/readable_form.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

Json fingerprint(const Json& number) { return fmt::format("{:016x}", number.get<std::uint64_t>()); }

Json drop_reason(const Json& number) {
  const auto row = number.get<std::size_t>();
  return row < kDropReasonCount ? kDropReasons[row].name : "unknown " + std::to_string(row);
}

static_assert(kEveryProcess == msg::ALL_ROBOTS);
Json number_or_all(const Json& number) {
  return number.get<std::uint32_t>() == msg::ALL_ROBOTS ? Json("all") : number;
}

Json number_or_none(const Json& number) {
  return number.get<std::uint32_t>() == msg::NO_ROBOT ? Json("none") : number;
}

Json client_name_text(const Json& octets) {
  std::string text;
  for (const Json& octet : octets) {
    if (octet == 0) break;
    text += static_cast<char>(octet.get<std::uint8_t>());
  }
  return text;
}

/// Replaces the ranges of beams without a hit, which JSON cannot represent as numbers, by words.
Json ranges(const Json& beams) {
  Json result = beams;
  for (Json& beam : result) {
    const auto range_m = beam.get<double>();
    if (!std::isfinite(range_m)) beam = std::isnan(range_m) ? "lost" : range_m > 0 ? "no hit" : "too near";
  }
  return result;
}

Json quantiles(const Json& histogram) {
  msg::DurationCounts counts;
  counts.max_ns(histogram["max_ns"]);
  counts.buckets() = histogram["buckets"].get<std::array<std::uint32_t, msg::HISTOGRAM_BUCKETS>>();
  const DurationHistogram durations = decode(counts);
  const auto us = [](Duration d) { return static_cast<double>(d.count()) * 1e-3; };
  return {{"count", durations.count()},
          {"p50_us", us(durations.quantile(0.5))},
          {"p99_us", us(durations.quantile(0.99))},
          {"max_us", us(durations.max())}};
}

struct Described {
  IdlTypePtr type;
  ReadableForm form;
};

/// The types of all topics, indexed by their IDL names.
std::map<std::string, Described> described_types() {
  const Rewrites rewrites{{"sidestep::msg::Header.rules", fingerprint},
                          {"sidestep::msg::Order.robot", number_or_all},
                          {"sidestep::msg::RememberedOrder.robot", number_or_all},
                          {"sidestep::msg::OrderTerms.client_name", client_name_text},
                          {"sidestep::msg::OrderStatus.client_name", client_name_text},
                          {"sidestep::msg::NetworkFault.target", number_or_all},
                          {"sidestep::msg::ContactPair.second", number_or_none},
                          {"sidestep::msg::Counter.robot", number_or_none},
                          {"sidestep::msg::Counter.reason", drop_reason},
                          {"sidestep::msg::LaserScan.ranges_m", ranges},
                          {"sidestep::msg::DurationCounts", quantiles}};
  const IdlTypes types = parse_idl(kIdlText, "idl");
  std::map<std::string, Described> result;
  for (const TopicInfo& topic : all_topics()) {
    const IdlTypePtr& type = types.at(topic.type.name);
    result.try_emplace(topic.type.name, Described{type, ReadableForm(*type, rewrites)});
  }
  return result;
}

}  // namespace

Json describe(const TopicInfo& topic, const void* message) {
  static const std::map<std::string, Described> types = described_types();
  const Described& described = types.at(topic.type.name);
  std::vector<std::uint8_t> bytes{0, 1, 0, 0};  // the encapsulation header of little-endian CDR
  append_cdr(topic, message, bytes);
  Json json = decode_by_idl(*described.type, bytes, OctetSequences::kText);
  described.form.apply(json);
  return json;
}

}  // namespace sidestep
