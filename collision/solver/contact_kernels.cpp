#define TOPPLE_KERNELS plain_kernels
#include "solver/contact_kernels.inl"
#undef TOPPLE_KERNELS

namespace topple::collision {

#ifdef __x86_64__
namespace avx2_kernels {
extern const ContactKernels kernels;
}
const ContactKernels& contact_kernels() {
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  return wide ? avx2_kernels::kernels : plain_kernels::kernels;
}
#else
const ContactKernels& contact_kernels() { return plain_kernels::kernels; }
#endif

}  // namespace topple::collision
