#include "elements/beam_unit_loads.h"

namespace topple::solver {

bool BeamUnitLoads::apply_to(const Beam& beam) {
  return (beam.end_stiffness[0].array() > 0).all() && (beam.end_stiffness[1].array() > 0).all();
}

void BeamUnitLoads::add(double size, const BeamLoad& load, Part part, int component, Vec12& force) {
  if (size == 0) return;
  for (const Unit& unit : known_)
    if (unit.part == part && unit.component == component && unit.kind == load.kind && unit.from == load.from &&
        unit.to == load.to) {
      force += size * unit.force;
      return;
    }
  BeamLoad one;
  one.beam = load.beam;
  one.kind = load.kind;
  one.from = load.from;
  one.to = load.to;
  if (part == Part::strain) one.strain = 1;
  if (part == Part::curvature_y) one.curvature_y = 1;
  if (part == Part::curvature_z) one.curvature_z = 1;
  if (part == Part::first || part == Part::both) one.first(component) = 1;
  if (part == Part::last || part == Part::both) one.last(component) = 1;
  known_.push_back({load.kind, part, component, load.from, load.to, beam_.fixed_end_forces({&one, 1}).force});
  force += size * known_.back().force;
}

Vec12 BeamUnitLoads::fixed_end_forces(std::span<const BeamLoad> loads) {
  Vec12 force = Vec12::Zero();
  for (const BeamLoad& load : loads) {
    if (load.kind == BeamLoad::Kind::temperature) {
      add(load.strain, load, Part::strain, 0, force);
      add(load.curvature_y, load, Part::curvature_y, 0, force);
      add(load.curvature_z, load, Part::curvature_z, 0, force);
      continue;
    }
    const bool varies = load.kind == BeamLoad::Kind::distributed && load.first != load.last;
    for (int c = 0; c < 6; ++c) {
      add(load.first(c), load, varies ? Part::first : Part::both, c, force);
      if (varies) add(load.last(c), load, Part::last, c, force);
    }
  }
  return force;
}

}  // namespace topple::solver
