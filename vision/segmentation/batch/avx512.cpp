// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_BYTES 64
#define SIDESTEP_KERNELS kAvx512Kernels
#define SIDESTEP_LEVEL "avx512"
#include "vision/segmentation/batch/classify_impl.hpp"
