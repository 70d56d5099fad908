// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/fault/plan/test_result.hpp"

namespace sidestep {

/// The results as JUnit XML: one test case for each run, with its time and everything that failed in it.
[[nodiscard]] std::string junit_xml(const std::vector<TestResult>& results);

/// The text for an XML 1.0 attribute or element. What XML cannot contain becomes '?'.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace sidestep
