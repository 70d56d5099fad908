// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/junit.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/file/xml_text.hpp"

namespace sidestep {
namespace {

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
