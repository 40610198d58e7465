// What results.json says beyond the single combinations: envelopes, losses, buckling, modes.
#include <algorithm>

#include "analysis/results/results_writer.h"

namespace topple::structure {

namespace {

/// The places of the least and the largest of value(0) ... value(count - 1); the first of equal ones.
template <class Value>
std::pair<std::size_t, std::size_t> least_and_largest(std::size_t count, Value value) {
  std::size_t least = 0, largest = 0;
  for (std::size_t k = 1; k < count; ++k) {
    if (value(k) < value(least)) least = k;
    if (value(k) > value(largest)) largest = k;
  }
  return {least, largest};
}

}  // namespace

void ResultsWriter::member_envelope(std::size_t m) {
  const std::vector<CombinationResult>& all = result_.combinations;
  const auto of = [&](std::size_t k) -> const MemberResult& { return all[k].members[m]; };
  w_.newline().raw_key(names_->members[m]).raw_value("{");
  const auto bound = [&](const Extreme& e, std::size_t q, std::size_t k, char* at) {
    at = w_.write(in_units(e.value, diagram_[q]), at);
    *at++ = ',';
    at = w_.write(in_units(e.at, b_.units.length), at);
    *at++ = ',';
    return put(names_->combinations[k], at);
  };
  for (std::size_t q = 0; q < 8; ++q) {
    const std::size_t low = least_and_largest(all.size(), [&](std::size_t k) { return of(k).min[q].value; }).first;
    const std::size_t high = least_and_largest(all.size(), [&](std::size_t k) { return of(k).max[q].value; }).second;
    constexpr std::size_t enough = 512;
    w_.compose(enough + names_->combinations[low].size() + names_->combinations[high].size(), [&](char* at) {
      at = names_->diagrams[q].put(at);
      at = put(R"(],"max":[)", bound(of(low).min[q], q, low, at));
      return put("]}", bound(of(high).max[q], q, high, at));
    });
  }
  w_.follow();
  if (result_.design_code && !all.front().designs[m].governing.empty()) {
    const std::size_t worst =
        least_and_largest(all.size(), [&](std::size_t k) { return all[k].designs[m].utilisation; }).second;
    w_.key("utilisation").open('[').value(all[worst].designs[m].utilisation);
    w_.value(b_[all[worst].combination].name).close(']');
  }
  w_.close('}');
}

void ResultsWriter::joint_envelope() {
  const std::vector<CombinationResult>& all = result_.combinations;
  w_.close('}').newline().key("joints").open('{');
  for (const std::size_t j : names_->breakable) {
    if (all.empty()) break;
    const std::size_t worst =
        least_and_largest(all.size(), [&](std::size_t k) { return all[k].joints[j].value; }).second;
    w_.newline().key(b_.joints[j].name).open('[').value(all[worst].joints[j].value);
    w_.value(b_[all[worst].combination].name).close(']');
  }
  w_.close('}');
}

void ResultsWriter::node_envelope(std::size_t n) {
  const std::vector<CombinationResult>& all = result_.combinations;
  w_.newline().raw_key(names_->nodes[n]).raw_value("{");
  for (std::size_t i = 0; i < 6; ++i) {
    const auto value = [&](std::size_t k) { return all[k].displacements[n](static_cast<Eigen::Index>(i)); };
    const auto [low, high] = least_and_largest(all.size(), value);
    constexpr std::size_t enough = 256;
    w_.compose(enough + names_->combinations[low].size() + names_->combinations[high].size(), [&](char* at) {
      at = w_.write(in_units(value(low), movement_[i]), names_->node_components[i].put(at));
      *at++ = ',';
      at = put(R"(],"max":[)", put(names_->combinations[low], at));
      at = w_.write(in_units(value(high), movement_[i]), at);
      *at++ = ',';
      return put("]}", put(names_->combinations[high], at));
    });
  }
  w_.follow().close('}');
}

void ResultsWriter::losses() {
  w_.key("losses").open('{');
  for (const MemberLoss& loss : result_.losses.losses) {
    w_.newline().key(b_[loss.member].name).open('{');
    for (const LossState& state : loss.states) {
      w_.key(b_[state.combination].name).open('{');
      state.stands() ? loss_state(state) : loss_mechanism(state);
      w_.close('}');
    }
    w_.close('}');
  }
  w_.close('}').newline();
}

void ResultsWriter::loss_mechanism(const LossState& state) {
  w_.key("mechanism").open('{').key("text").value(state.mechanism).key("nodes").open('{');
  for (const auto& [node, motion] : state.motion) {
    w_.key(b_[node].name);
    shape_of(motion);
  }
  w_.close('}').key("members").open('[');
  for (const MemberId member : state.loose) w_.value(b_[member].name);
  w_.close(']').close('}');
}

void ResultsWriter::loss_state(const LossState& state) {
  if (state.worst.valid()) {
    w_.key("worst")
        .open('{')
        .key("joint")
        .value(b_[state.worst].name)
        .key("utilisation")
        .value(state.utilisation.value);
    w_.key("governing").value(sense_names[static_cast<std::size_t>(state.utilisation.sense)]).close('}');
  }
  w_.key("survives").value(state.survives()).key("displacements").open('{');
  for (std::size_t n = 0; n < state.displacements.size(); ++n) {
    w_.raw_key(names_->nodes[n]);
    list(state.displacements[n], movement_, 6);
  }
  w_.close('}').key("members").open('{');
  for (const auto& [member, forces] : state.end_forces) {
    w_.key(b_[member].name).open('{').key("end_forces");
    list(forces, force_, 12);
    w_.close('}');
  }
  w_.close('}').key("joints").open('{');
  for (const auto& [id, used] : state.joints) joint(b_[id], used);
  w_.close('}');
  if (state.dynamic) motion(*state.dynamic);
}

/// A shape's largest translation is 1, whatever the unit of length; its rotations go with it.
void ResultsWriter::shape_of(const Vec6& motion) {
  const std::array<double, 6> scale{1, 1, 1, 1 / b_.units.length, 1 / b_.units.length, 1 / b_.units.length};
  list(motion, scale, 6);
}

void ResultsWriter::buckling() {
  w_.key("buckling").open('{');
  for (const CombinationResult& c : result_.combinations) {
    w_.newline().key(b_[c.combination].name).open('[');
    for (const solver::BucklingMode& mode : c.buckling) {
      w_.newline().open('{').key("factor").value(mode.factor);
      shape(mode.shape);
      w_.close('}');
    }
    w_.close(']');
  }
  w_.close('}').newline();
}

void ResultsWriter::modes() {
  w_.key("modes").open('[');
  for (const solver::VibrationMode& mode : result_.modes) {
    constexpr double pi = 3.14159265358979323846;
    w_.newline().open('{').key("frequency").value(mode.angular_frequency / (2 * pi));
    w_.key("angular_frequency").value(mode.angular_frequency).key("mass_share");
    list(mode.mass_share, std::array<double, 1>{1}, 6);
    shape(mode.shape);
    w_.close('}');
  }
  w_.close(']').newline();
}

void ResultsWriter::shape(const std::vector<Vec6>& motion) {
  w_.key("shape").open('{');
  for (const std::size_t n : names_->written.nodes) {
    w_.raw_key(names_->nodes[n]);
    shape_of(motion[n]);
  }
  for (const std::size_t m : names_->written.members) {
    if (result_.mode_cuts.empty()) break;
    const std::vector<int>& cuts = result_.mode_cuts[m];
    if (cuts.empty() || static_cast<std::size_t>(cuts.back()) >= motion.size()) continue;  // a buckling shape
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      w_.key(b_.members[m].name + "/cut-" + std::to_string(i + 1));
      shape_of(motion[static_cast<std::size_t>(cuts[i])]);
    }
  }
  w_.close('}');
}

void ResultsWriter::seconds() {
  w_.key("seconds").open('{');
  for (const auto& [stage, time] : seconds_) w_.key(stage).value(time);
  w_.close('}');
}

}  // namespace topple::structure
