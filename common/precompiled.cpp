// SPDX-License-Identifier: Apache-2.0
// Empty source file for the CMake targets that precompile headers, because a target needs one.
