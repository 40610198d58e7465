#include "parallel/serial_regions.h"

#if defined(__unix__)
#include <dlfcn.h>
#endif

namespace topple::solver {

namespace {

struct OpenMp {
  int (*levels)() = nullptr;
  void (*set_levels)(int) = nullptr;
};

/// The OpenMP that CHOLMOD brought along, if it did: looked up, so that this library needs none itself.
const OpenMp& open_mp() {
  static const OpenMp found = [] {
    OpenMp symbols;
#if defined(__unix__)
    symbols.levels = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
    symbols.set_levels = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
#endif
    return symbols;
  }();
  return found;
}

}  // namespace

SerialRegions::SerialRegions() {
  const OpenMp& omp = open_mp();
  if (omp.levels == nullptr || omp.set_levels == nullptr) return;
  levels_ = omp.levels();
  omp.set_levels(0);
}

SerialRegions::~SerialRegions() {
  if (levels_ >= 0) open_mp().set_levels(levels_);
}

}  // namespace topple::solver
