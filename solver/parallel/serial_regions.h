#pragma once
// CHOLMOD opens OpenMP regions of a fixed number of threads for every supernode. With no cores to spare they cost more
// than they bring, and we parallelise above it.

namespace topple::solver {

/// While it lives, OpenMP regions opened by this thread run on it alone. Does nothing where there is no OpenMP.
class SerialRegions {
 public:
  SerialRegions();
  ~SerialRegions();
  SerialRegions(const SerialRegions&) = delete;
  SerialRegions& operator=(const SerialRegions&) = delete;

 private:
  int levels_ = -1;
};

}  // namespace topple::solver
