// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/batch/kernel_tables.hpp"

#define SIDESTEP_VECTOR_BYTES 32
#define SIDESTEP_KERNELS kAvx2Kernels
#define SIDESTEP_LEVEL "avx2"
#include "vision/segmentation/batch/classify_impl.hpp"
