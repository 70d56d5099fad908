// SPDX-License-Identifier: Apache-2.0
#include "common/collision/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_WIDTH 16
#define SIDESTEP_LEVEL "avx512"
#define SIDESTEP_KERNELS kAvx512Kernels
#include "common/collision/batch/kernels_impl.hpp"
