#pragma once
// Rayleigh damping of what moves: found for a component as it stood when it began to move, and anew where joints have
// broken since. The share of critical damping is that of its materials, each by the energy that it stores under the
// loads; it holds at the lowest frequency of what is no loose part alone, and at that of the static shape.
#include <map>
#include <vector>

#include "standing/motion/motion_model.h"
#include "standing/motion/motion_settings.h"

namespace topple::structure {

class ComponentDamping {
 public:
  /// All must outlive it.
  ComponentDamping(const MotionSources& sources, const MotionModel& model, const MotionSettings& settings)
      : from_(sources), model_(model), settings_(settings) {}

  /// The component begins to move, as this model.
  const solver::RayleighDamping& start(int component, const solver::FrameModel& frame, const solver::MassModel& masses,
                                       const std::vector<Vec6>& rest);
  /// It is looked at for rest, and its statics were solved. Where joints have broken since its damping was found, but
  /// none since the last look: its damping, found anew; else null.
  [[nodiscard]] const solver::RayleighDamping* update(int component);
  /// Of what does not fall.
  [[nodiscard]] const solver::RayleighDamping& of(int component) const { return known_.at(component).damping; }
  /// rad/s, the lowest of a component that has begun to move, as its damping was found.
  [[nodiscard]] double first_frequency(int component) const { return known_.at(component).first_frequency; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [from, model, settings, known] = *this;
    archive(known);
  }

 private:
  struct Known {
    double first_frequency = 1;  ///< rad/s; of what cannot move any
    solver::RayleighDamping damping;
    std::size_t holding = 0;  ///< its joints that held
    std::size_t looked = 0;   ///< the same at the last look for rest
  };
  template <class Archive>
  friend void serialize(Archive& archive, Known& known) {
    auto& [first_frequency, damping, holding, looked] = known;
    archive(first_frequency, damping, holding, looked);
  }
  [[nodiscard]] std::size_t holding(int component) const;
  [[nodiscard]] double share(int component) const;
  [[nodiscard]] Known find(int component, const solver::FrameModel& frame, const solver::MassModel& masses,
                           const std::vector<Vec6>& rest) const;

  MotionSources from_;
  const MotionModel& model_;
  MotionSettings settings_;
  std::map<int, Known> known_;
};

}  // namespace topple::structure
