#include "reanalysis/work_count.h"

#include <utility>

namespace topple::solver {

namespace {
thread_local double counted = 0;
}  // namespace

void count_work(double nanoseconds) { counted += nanoseconds; }

CountedWork::CountedWork() : before_(std::exchange(counted, 0)) {}
CountedWork::~CountedWork() { counted += before_; }
double CountedWork::so_far() const { return counted; }

}  // namespace topple::solver
