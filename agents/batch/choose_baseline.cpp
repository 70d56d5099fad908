// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 2
#define SIDESTEP_KERNELS kBaselineChoice
#include "agents/batch/choose_impl.hpp"
