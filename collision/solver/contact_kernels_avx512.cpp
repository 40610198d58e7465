// The same loops for processors with AVX-512 (set in CMakeLists.txt, for this file alone): vectors of four still, by
// its twice as many registers and its masks.
#ifdef __x86_64__
#define TOPPLE_KERNELS avx512_kernels
#include "solver/contact_kernels.inl"
#endif
