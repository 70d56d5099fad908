// SPDX-License-Identifier: Apache-2.0
// Empty: the target that it is in carries the headers that tests read precompiled (tests/CMakeLists.txt).
