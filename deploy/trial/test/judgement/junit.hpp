// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/trial/test/judgement/test_result.hpp"

namespace sidestep {

/// The results as JUnit XML, with one test case per run that contains its duration and everything that
/// failed.
[[nodiscard]] std::string junit_xml(const std::vector<TestResult>& results);

}  // namespace sidestep
