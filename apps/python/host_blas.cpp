#include "host_blas.h"

#include <mutex>

extern "C" {
int openblas_get_num_threads();
void openblas_set_num_threads(int);
}

namespace topple::python {

namespace {

std::mutex guard;
int users = 0;
int threads_of_host = 1;

}  // namespace

HostBlas::HostBlas() {
  const std::lock_guard lock(guard);
  if (users++ > 0) return;
  threads_of_host = openblas_get_num_threads();
  if (threads_of_host != 1) openblas_set_num_threads(1);
}

HostBlas::~HostBlas() {
  const std::lock_guard lock(guard);
  if (--users > 0) return;
  if (threads_of_host != openblas_get_num_threads()) openblas_set_num_threads(threads_of_host);
}

}  // namespace topple::python
