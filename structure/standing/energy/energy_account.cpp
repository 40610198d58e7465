#include "standing/energy/energy_account.h"

namespace topple::structure {

EnergyAccount::EnergyAccount(const SolvedFrame& frame)
    : now_(frame), rest_(now_), rests_(static_cast<std::size_t>(frame.statics.components())), changes_(rests_.size()) {}

void EnergyAccount::start() {
  started_ = true;
  for (int c = 0; c < now_.statics.components(); ++c) {
    for (MemberId member : now_.statics.members(c)) rest_.record_loads(member);
    for (NodeId node : now_.statics.nodes(c)) rest_.record_loads(node);
    rest_.record(c);
    rests_[static_cast<std::size_t>(c)].reset();
    elastic_at_start_ += rest(c).elastic;
    start_ += rest(c).work;
  }
}

const EnergyAccount::Rest& EnergyAccount::rest(int component) const {
  std::optional<Rest>& sums = rests_[static_cast<std::size_t>(component)];
  if (!sums) {
    static const std::map<PanelId, PanelAtRest> none;
    const auto& change = changes_[static_cast<std::size_t>(component)];
    sums = {rest_.load_work(component), rest_.contact_work(component),
            rest_.elastic(component, change ? change->panels() : none)};
  }
  return *sums;
}

ChangeFromRest& EnergyAccount::change(int component) {
  std::optional<ChangeFromRest>& change = changes_[static_cast<std::size_t>(component)];
  if (!change) change.emplace(now_, rest_);
  return *change;
}

void EnergyAccount::write(MemberId member) {
  if (started_) change(member).write(member);
}

void EnergyAccount::write(NodeId node, const Vec6& before) {
  if (started_) change(node).write(node, before);
}

void EnergyAccount::turn_gravity() {
  for (int c = 0; c < now_.statics.components(); ++c) {
    (void)rest(c);  // by the direction that gravity has had so far
    change(c);
  }
}

void EnergyAccount::gravity_turned(const Vec3& gravity) {
  if (gravity.norm() > 0) now_.gravity = gravity.normalized();
  for (int c = 0; c < now_.statics.components(); ++c)
    // What moves already counts within what is freed.
    if (!change(c).moves()) change(c).turn_gravity(rest(c).work, now_.load_work(c));
}

void EnergyAccount::finish(int component, bool slow, std::vector<JointBreak>& breaks) {
  std::optional<ChangeFromRest>& change = changes_[static_cast<std::size_t>(component)];
  if (!change) return;
  const ChangeFromRest::Sums sums = change->finish(component, slow, breaks);
  past_.left += sums.left;
  past_.contact_left += sums.contact_left;
  past_.freed += sums.freed;
  past_.dissipated += sums.dissipated;
  change->commit_to(rest_);
  change.reset();
  rest_.record(component);
  rests_[static_cast<std::size_t>(component)].reset();
}

void EnergyAccount::lines_are_out() {
  for (std::optional<ChangeFromRest>& change : changes_)
    if (change) change->forget_lines();
}

FrameEnergy EnergyAccount::energy() const {
  FrameEnergy energy;
  energy.elastic_at_start = elastic_at_start_;
  energy.gravity_work = past_.left.gravity - start_.gravity;
  energy.other_work = past_.left.other - start_.other;
  energy.contact_work = past_.contact_left;
  energy.freed = past_.freed;
  energy.dissipated = past_.dissipated;
  for (int c = 0; c < now_.statics.components(); ++c) {
    const Rest& sums = rest(c);
    energy.elastic += sums.elastic;
    energy.gravity_work += sums.work.gravity;
    energy.other_work += sums.work.other;
    energy.contact_work += sums.contact;
  }
  return energy;
}

}  // namespace topple::structure
