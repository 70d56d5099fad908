// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/trial/test/judgement/test_result.hpp"

namespace sidestep {

/// The results as JUnit XML, with one test case per run that contains its duration and everything that
/// failed.
[[nodiscard]] std::string junit_xml(const std::vector<TestResult>& results);

/// Escapes a text for an XML 1.0 attribute or element. Characters that XML cannot contain become '?'.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace sidestep
