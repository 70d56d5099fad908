// SPDX-License-Identifier: Apache-2.0
// A guard instead of #pragma once: this file is in a precompiled header, which a cache may have made from a
// copy of another date, and g++ takes copies of different dates for different files.
#ifndef SIDESTEP_TESTS_CATCH_HPP
#define SIDESTEP_TESTS_CATCH_HPP

// Catch2 2 or 3, whichever is installed, with the names of version 3. Only this file knows which one it is.

#if __has_include(<catch2/catch_test_macros.hpp>)

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

#else

#include <catch2/catch.hpp>
#include <string>

/// Version 2's matcher of substrings, under the name of version 3.
inline auto ContainsSubstring(const std::string& text) { return Catch::Matchers::Contains(text); }

#endif

using Catch::Matchers::EndsWith;
using Catch::Matchers::Equals;
using Catch::Matchers::Matches;
using Catch::Matchers::StartsWith;

#endif  // SIDESTEP_TESTS_CATCH_HPP
