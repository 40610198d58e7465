#pragma once
// Wall time of a step by stage, and of the collision engine within it. Times are reported; no decision depends on them.
#include <array>
#include <chrono>

namespace topple::structure {

class StageTimer {
 public:
  void start_step() {
    stages_.fill(0);
    engine_ = 0;
  }
  /// Runs `work` and books its time under a stage.
  template <class Work>
  auto stage(std::size_t index, const Work& work) {
    const Span span(stages_[index]);
    return work();
  }
  /// Of a stage's work within that of another and of the collision engine: counted there, and not here.
  template <class Work>
  void within(std::size_t outer, std::size_t index, const Work& work) {
    double took = 0;
    {
      const Span span(took);
      work();
    }
    stages_[index] += took;
    stages_[outer] -= took;
    engine_ -= took;
  }
  template <class Work>
  auto engine(const Work& work) {
    const Span span(engine_);
    return work();
  }
  [[nodiscard]] const std::array<double, 6>& stages() const { return stages_; }
  [[nodiscard]] double engine_seconds() const { return engine_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Span {
    explicit Span(double& seconds) : total(seconds) {}
    ~Span() { total += std::chrono::duration<double>(Clock::now() - begin).count(); }
    double& total;
    Clock::time_point begin = Clock::now();
  };
  std::array<double, 6> stages_{};
  double engine_ = 0;
};

}  // namespace topple::structure
