#pragma once
// numpy and the library share one OpenBLAS in a process, and the library runs it on one thread: its own threads work
// above BLAS, and sums keep their order.

namespace topple::python {

/// While any of these lives, BLAS belongs to the library; when the last goes, the host has its number of threads again.
class HostBlas {
 public:
  HostBlas();
  ~HostBlas();
  HostBlas(const HostBlas&) = delete;
  HostBlas& operator=(const HostBlas&) = delete;
};

}  // namespace topple::python
