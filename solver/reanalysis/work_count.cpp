#include "reanalysis/work_count.h"

namespace topple::solver {

namespace {
thread_local double counted = 0;
}  // namespace

void count_work(double nanoseconds) { counted += nanoseconds; }
double counted_work() { return counted; }

}  // namespace topple::solver
