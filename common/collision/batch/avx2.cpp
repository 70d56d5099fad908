// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 8
#define SIDESTEP_LEVEL "avx2"
#define SIDESTEP_KERNELS kAvx2Kernels
#include "common/collision/batch/kernels_impl.hpp"
