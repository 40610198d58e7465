// The same loops for processors with AVX2 (set in CMakeLists.txt, for this file alone).
#ifdef __x86_64__
#define TOPPLE_KERNELS avx2_kernels
#include "solver/contact_kernels.inl"
#endif
