#include "app/session.h"

#include <utility>

namespace topple::viewer {
namespace {

/// A person's session has no end of its own (s).
constexpr double endless = 1e9;

}  // namespace

Session::Session(std::shared_ptr<const structure::Building> building, structure::Scenario scenario)
    : building_(std::move(building)), scenario_(std::move(scenario)) {
  scenario_.duration = endless;
  scenario_.until_rest = false;
  begin();
}

void Session::begin() {
  simulation_ = std::make_unique<structure::Simulation>(*building_, scenario_);
  taker_ = SnapshotTaker();
  taker_.want(wanted_);
}

void Session::step() { simulation_->step(); }

void Session::apply(const structure::Tool& tool) {
  actions_.push_back({simulation_->steps(), tool});
  simulation_->apply(tool);
}

void Session::restart() {
  actions_.clear();
  begin();
}

bool Session::undo() {
  if (actions_.empty()) return false;
  const std::int64_t until = actions_.back().step;
  actions_.pop_back();
  begin();
  auto next = actions_.begin();
  const auto act = [&] {
    for (; next != actions_.end() && next->step == simulation_->steps(); ++next) simulation_->apply(next->tool);
  };
  for (act(); simulation_->steps() < until; act()) simulation_->step();
  return true;
}

std::shared_ptr<const Snapshot> Session::snapshot() {
  return std::make_shared<const Snapshot>(taker_.take(*simulation_));
}

}  // namespace topple::viewer
