#include "topple/solver/paced_work.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "parallel/strand.h"

namespace topple::solver {

struct PacedWork::State {
  State() : strand([this] { run(); }) {}

  std::function<void()> work;
  bool under_way = false;  ///< begun and not done
  bool ended = true;
  bool begun = false;   ///< the strand was ever run
  bool leaves = false;  ///< the strand is to end
  double granted = 0, spent = 0;
  double in_all = 0;  ///< spent by all pieces of work so far
  std::exception_ptr thrown;
  Strand strand;
  static thread_local State* running;  ///< the work that runs on this thread

  void run();
  /// Hands over to the work until it waits or ends.
  void hand_over() {
    begun = true;
    State* const before = std::exchange(running, this);
    strand.run();
    running = before;
  }
};

thread_local PacedWork::State* PacedWork::State::running = nullptr;

double whole_operations(double operations) { return std::ceil(operations); }

/// Whoever lets it go on may do so from another thread than before.
void PacedWork::State::run() {
  running = this;
  while (!leaves) {
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    work = nullptr;
    ended = true;
    strand.wait();
  }
}

namespace {
thread_local double outside = 0;
}  // namespace

double spent_here() {
  const PacedWork::State* own = PacedWork::State::running;
  return own != nullptr ? own->in_all : outside;
}

void spend(double operations) {
  PacedWork::State* own = PacedWork::State::running;
  if (own == nullptr) {
    outside += whole_operations(operations);
    return;
  }
  own->spent += whole_operations(operations);
  own->in_all += whole_operations(operations);
  if (own->spent > own->granted) own->strand.wait();
}

PacedWork::PacedWork() : state_(std::make_unique<State>()) {}

PacedWork::~PacedWork() {
  run_out();
  if (!state_->begun) return;
  state_->leaves = true;
  state_->strand.run();
}

void PacedWork::begin(std::function<void()> work) {
  State& own = *state_;
  own.work = std::move(work);
  own.under_way = true;
  own.ended = false;
  own.granted = own.spent = 0;
}

bool PacedWork::runs_here() const { return State::running == state_.get(); }

bool PacedWork::done() const { return !state_->under_way; }

double PacedWork::go_on(double operations) {
  State& own = *state_;
  if (!own.under_way) return operations;
  own.granted += operations;
  if (!own.ended && own.spent <= own.granted) own.hand_over();
  if (!own.ended || own.spent > own.granted) return 0;
  own.under_way = false;
  if (own.thrown) std::rethrow_exception(std::exchange(own.thrown, nullptr));
  return own.granted - own.spent;
}

void PacedWork::run_out() {
  State& own = *state_;
  if (!own.under_way || own.ended || runs_here()) return;
  const double granted = std::exchange(own.granted, std::numeric_limits<double>::infinity());
  own.hand_over();
  own.granted = granted;
}

double PacedWork::finish() {
  State& own = *state_;
  run_out();
  const double owed = own.under_way ? std::max(0.0, own.spent - own.granted) : 0;
  own.granted += owed;
  (void)go_on(0);
  return owed;
}

}  // namespace topple::solver
