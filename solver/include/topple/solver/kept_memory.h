#pragma once
// Memory of factorisations that follow each other.

namespace topple::solver {

/// While one of these lives, the largest blocks of memory that factors let go of wait for the next one (six at most, in
/// sum three times the largest).
/// The system clears every page that it gives out, which for a large factor takes about as long as the arithmetic. They
/// may be made and destroyed on any thread; the last to go frees what waits.
class KeptMemory {
 public:
  KeptMemory();
  ~KeptMemory();
  KeptMemory(const KeptMemory&) = delete;
  KeptMemory& operator=(const KeptMemory&) = delete;
};

}  // namespace topple::solver
