// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 4
#define SIDESTEP_LEVEL "baseline"
#define SIDESTEP_KERNELS kBaselineKernels
#include "common/collision/batch/kernels_impl.hpp"
