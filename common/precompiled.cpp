// SPDX-License-Identifier: Apache-2.0
// Source of the targets that precompile headers; they need one.
