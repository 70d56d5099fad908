// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 2
#define SIDESTEP_KERNELS kBaselineComparison
#include "agents/batch/compare_impl.hpp"
