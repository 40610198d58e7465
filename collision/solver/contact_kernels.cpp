#define TOPPLE_KERNELS plain_kernels
#include "solver/contact_kernels.inl"
#undef TOPPLE_KERNELS

namespace topple::collision {

#ifdef __x86_64__
namespace avx2_kernels {
extern const ContactKernels kernels;
}
namespace avx512_kernels {
extern const ContactKernels kernels;
}
#endif

std::vector<const ContactKernels*> usable_contact_kernels() {
  std::vector<const ContactKernels*> usable{&plain_kernels::kernels};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) usable.push_back(&avx2_kernels::kernels);
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    usable.push_back(&avx512_kernels::kernels);
#endif
  return usable;
}

const ContactKernels& contact_kernels() {
  static const ContactKernels& widest = *usable_contact_kernels().back();
  return widest;
}

}  // namespace topple::collision
