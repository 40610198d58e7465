#include "parallel/strand.h"

#include <utility>

#if __has_include(<ucontext.h>) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TOPPLE_SWITCHES_STACKS
#include <ucontext.h>

#include <cstdint>
#include <new>
#else
#include <semaphore>
#include <thread>
#endif

namespace topple::solver {

#ifdef TOPPLE_SWITCHES_STACKS

namespace {
/// Pages that are never used take no memory.
constexpr std::size_t stack_size = std::size_t{8} << 20;
}  // namespace

struct Strand::State {
  std::function<void()> body;
  std::unique_ptr<char[]> stack;
  ucontext_t owner, own;

  /// makecontext() hands on integers alone.
  static void begin(unsigned high, unsigned low) {
    const auto address = static_cast<std::uintptr_t>(high) << 32 | low;
    reinterpret_cast<State*>(address)->body();
  }
  void make() {
    stack.reset(new char[stack_size]);
    getcontext(&own);
    own.uc_stack.ss_sp = stack.get();
    own.uc_stack.ss_size = stack_size;
    own.uc_link = &owner;
    const auto address = reinterpret_cast<std::uintptr_t>(this);
    makecontext(&own, reinterpret_cast<void (*)()>(&State::begin), 2, static_cast<unsigned>(address >> 32),
                static_cast<unsigned>(address & 0xffffffffu));
  }
};

Strand::Strand(std::function<void()> body) : state_(std::make_unique<State>()) { state_->body = std::move(body); }
Strand::~Strand() = default;

void Strand::run() {
  if (!state_->stack) state_->make();
  swapcontext(&state_->owner, &state_->own);
}

void Strand::wait() { swapcontext(&state_->own, &state_->owner); }

#else

struct Strand::State {
  std::function<void()> body;
  std::binary_semaphore to_body{0}, to_owner{0};
  std::thread thread;
};

Strand::Strand(std::function<void()> body) : state_(std::make_unique<State>()) { state_->body = std::move(body); }

Strand::~Strand() {
  if (state_->thread.joinable()) state_->thread.join();
}

void Strand::run() {
  State& own = *state_;
  if (!own.thread.joinable())
    own.thread = std::thread([&own] {
      own.to_body.acquire();
      own.body();
      own.to_owner.release();
    });
  own.to_body.release();
  own.to_owner.acquire();
}

void Strand::wait() {
  state_->to_owner.release();
  state_->to_body.acquire();
}

#endif

}  // namespace topple::solver
