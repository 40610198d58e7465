#include "topple/solver/blas_kernel.h"

#include <cstdlib>

#if defined(__unix__)
#include <unistd.h>
#endif

extern "C" {
char* openblas_get_corename();
void openblas_set_num_threads(int);
#if defined(__linux__)
__attribute__((weak)) int blas_thread_shutdown_();  // not there where OpenBLAS has been built without threads
#endif
}

namespace topple::solver {

namespace {

constexpr const char* variable = "OPENBLAS_CORETYPE";
/// BLAS runs on one thread in any case; told so before it is loaded, it starts none.
constexpr const char* threads = "OPENBLAS_NUM_THREADS";

/// Kernels for this processor's instruction set; empty when OpenBLAS's own choice cannot be bettered.
std::string kernel_for_processor() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return {};
}

/// Speed class of kernels by the width of their arithmetic: names that share a class are equally good here.
int width_class(const std::string& kernel) {
  for (const char* wide : {"SkylakeX", "Cooperlake", "SapphireRapids"})
    if (kernel == wide) return 2;
  for (const char* middle : {"Haswell", "Zen", "Excavator"})
    if (kernel == middle) return 1;
  return 0;
}

#if defined(__linux__)
void end_blas_threads() {
  if (blas_thread_shutdown_ == nullptr) return;
  openblas_set_num_threads(1);
  blas_thread_shutdown_();
}
#endif

}  // namespace

std::string blas_kernel() { return openblas_get_corename(); }

std::optional<std::string> better_blas_kernel() {
  if (std::getenv(variable) != nullptr) return std::nullopt;
  const std::string wanted = kernel_for_processor();
  if (wanted.empty() || width_class(blas_kernel()) >= width_class(wanted)) return std::nullopt;
  return wanted;
}

void prepare_blas([[maybe_unused]] char** argv) {
#if defined(__linux__)
  const auto wanted = better_blas_kernel();
  if (!wanted) return end_blas_threads();
  // The variable, once set, also keeps the restarted program from starting again.
  if (setenv(variable, wanted->c_str(), 1) != 0) return;
  setenv(threads, "1", 0);
  execv("/proc/self/exe", argv);
  unsetenv(variable);  // the restart was refused: go on with what there is
  end_blas_threads();
#endif
}

}  // namespace topple::solver
