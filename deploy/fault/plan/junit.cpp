// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/plan/junit.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sidestep {
namespace {

/// Length of the UTF-8 sequence (RFC 3629) at this position if XML 1.0 may contain its character, else 0.
std::size_t character_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  std::uint32_t code = first & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::uint32_t kShortest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  const bool is_valid = first >= 0xc2 && first < 0xf5 && code >= kShortest[length] && code <= 0x10ffff &&
                        !is_surrogate && code != 0xfffe && code != 0xffff;
  return is_valid ? length : 0;
}

std::string test_case(const TestResult& result) {
  const std::string name = fmt::format("{}, seed {}", result.file, result.seed);
  std::string xml = fmt::format("  <testcase classname=\"sidestep.{}\" name=\"{}\" time=\"{:.3f}\"",
                                result.bus, xml_escaped(name), result.wall_s);
  const std::vector<std::string> failures = result.failures();
  if (failures.empty()) return xml + "/>\n";
  const char* const element = result.error.empty() ? "failure" : "error";
  xml +=
      fmt::format(">\n    <{0} message=\"{1}\">{2}</{0}>\n  </testcase>\n", element,
                  xml_escaped(failures.front()), xml_escaped(fmt::format("{}", fmt::join(failures, "\n"))));
  return xml;
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    const std::string character = length == 0 ? "?" : text.substr(at, length);
    at += std::max<std::size_t>(length, 1);
    if (character == "&")
      result += "&amp;";
    else if (character == "<")
      result += "&lt;";
    else if (character == ">")
      result += "&gt;";
    else if (character == "\"")
      result += "&quot;";
    else if (character == "\n" || character == "\r" || character == "\t")
      result += fmt::format("&#{};", static_cast<int>(character[0]));
    else
      result += character;
  }
  return result;
}

std::string junit_xml(const std::vector<TestResult>& results) {
  const auto has_error = [](const TestResult& result) { return !result.error.empty(); };
  const auto has_failure = [&](const TestResult& result) { return !has_error(result) && !result.passed(); };
  double time_s = 0;
  std::string cases;
  for (const TestResult& result : results) {
    time_s += result.wall_s;
    cases += test_case(result);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"sidestep test\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n{}"
      "</testsuite>\n",
      results.size(), std::ranges::count_if(results, has_failure), std::ranges::count_if(results, has_error),
      time_s, cases);
}

}  // namespace sidestep
