// The state of a FrameDynamics as bytes, and back.
#include <Eigen/SparseCore>
#include <istream>
#include <ostream>
#include <vector>

#include "description_archive.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/following_factor.h"
#include "dynamics/jumps.h"
#include "dynamics/shorter_substeps.h"
#include "state_archive.h"

namespace cereal {

template <class Archive>
void save(Archive& archive, const Eigen::SparseVector<double>& vector) {
  std::vector<std::int64_t> place;
  std::vector<double> value;
  for (Eigen::SparseVector<double>::InnerIterator entry(vector); entry; ++entry) {
    place.push_back(entry.index());
    value.push_back(entry.value());
  }
  archive(static_cast<std::int64_t>(vector.size()), place, value);
}
template <class Archive>
void load(Archive& archive, Eigen::SparseVector<double>& vector) {
  std::int64_t size = 0;
  std::vector<std::int64_t> place;
  std::vector<double> value;
  archive(size, place, value);
  vector.resize(size);
  vector.reserve(static_cast<Eigen::Index>(place.size()));
  for (std::size_t k = 0; k < place.size(); ++k) vector.insertBack(place[k]) = value[k];
}

}  // namespace cereal

namespace topple::solver {

void FrameDynamics::State::FollowingFactor::save_to(std::ostream& to) const {
  const auto& [softened, own_inertia, frame, ratio, followed] = *this;  // inertia: the frame's, and softening
  frame.save_state(to);
  StateWriter archive(to);
  archive(ratio, followed);
}

void FrameDynamics::State::FollowingFactor::load_from(std::istream& from) {
  frame_.load_state(from);
  StateReader archive(from);
  archive(ratio_, followed_);
}

void FrameDynamics::State::Jumps::save_to(std::ostream& to) const {
  const auto& [options, softened, factor] = *this;
  StateWriter archive(to);
  archive(softened, factor != nullptr);
  if (factor) factor->save_to(to);
}

void FrameDynamics::State::Jumps::load_from(std::istream& from, const FrameSystem& system) {
  StateReader archive(from);
  bool made = false;
  archive(softened_, made);
  factor_.reset();
  if (!made) return;
  factor_ = std::make_unique<FollowingFactor>(system, options_, softened_);
  factor_->load_from(from);
}

void FrameDynamics::State::ShorterSubsteps::save_to(std::ostream& to) const {
  StateWriter archive(to);
  archive(factors_.size());
  for (const auto& [parts, one] : factors_) {
    archive(parts, one.s);
    one.factor->save_to(to);
  }
}

void FrameDynamics::State::ShorterSubsteps::load_from(std::istream& from, const FrameSystem& system) {
  StateReader archive(from);
  factors_.clear();
  std::size_t count = 0;
  archive(count);
  for (std::size_t k = 0; k < count; ++k) {
    int parts = 0;
    One one;
    archive(parts, one.s);
    one.factor = std::make_unique<FollowingFactor>(system, options_, 1 / one.s);
    one.factor->load_from(from);
    factors_.emplace(parts, std::move(one));
  }
}

void FrameDynamics::save_state(std::ostream& to) const {
  // Of the options damping alone changes, of inertia its factor, which is the method's. The load that acts in a
  // substep, the geometric one, the equation and what is foreseen are found in each substep anew.
  const auto& [options, whole, method, parts, inertia, frame, patterns, recent_loads, kinks, time, before, now,
               accepted, started_at, nodes, foreseen, reactions, ledger, constant_load, collocated_load, substep_load,
               geometric, changed, waiting, jumps, shorter, prepared, counters, breaks, equation] = *state_;
  frame.save_state(to);
  StateWriter archive(to);
  archive(options.damping, whole, method, parts, patterns, recent_loads, kinks, time, before, now, accepted, started_at,
          nodes, reactions, ledger, constant_load, substep_load, changed, waiting, prepared, counters, breaks);
  jumps->save_to(to);
  shorter->save_to(to);
}

void FrameDynamics::load_state(std::istream& from) {
  State& state = *state_;
  state.frame.load_state(from);
  StateReader archive(from);
  archive(state.options.damping, state.whole, state.method, state.parts, state.patterns, state.recent_loads,
          state.kinks, state.time, state.before, state.now, state.accepted, state.started_at, state.nodes,
          state.reactions, state.ledger, state.constant_load, state.substep_load, state.changed, state.waiting,
          state.prepared, state.counters, state.breaks);
  state.foreseen.clear();
  state.inertia.factor = state.whole.s;
  state.jumps->load_from(from, state.system());
  state.shorter->load_from(from, state.system());
}

}  // namespace topple::solver
