// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_KERNELS kAvx512Choice
#include "agents/batch/choose_impl.hpp"
