#pragma once
// What the solver's public description structs and answers are in an archive (state_archive.h).
#include <cstdint>
#include <vector>

#include "topple/solver/frame_dynamics.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/reanalysis.h"

namespace topple::solver {

/// What may change of a model once an analysis has it; all else is as it was given.
template <class Archive, class Model>
void archive_changes(Archive& archive, Model& model) {
  auto& [nodes, beams, shells, supports, diaphragms, shell_stiffness, patches] = model;
  for (auto& beam : beams) {
    auto& [node, offset, axes, length, youngs_modulus, shear_modulus, area, shear_area_y, shear_area_z, Iy, Iz, J,
           density, end_stiffness, axial] = beam;
    archive(density, end_stiffness);
  }
  for (auto& support : supports) archive(support.stiffness);
  archive(shell_stiffness);
  for (auto& patch : patches) {
    auto& [node, stiffness, mass] = patch;
    archive(stiffness, mass);
  }
}

template <class Archive>
void serialize(Archive& archive, BeamLoad& load) {
  auto& [beam, kind, from, to, first, last, strain, curvature_y, curvature_z] = load;
  archive(beam, kind, from, to, first, last, strain, curvature_y, curvature_z);
}
/// Not by serialize() of one of them: its member `load` passes for cereal's function of that name, and nothing would be
/// read.
template <class Archive>
void archive_node_loads(Archive& archive, std::vector<NodeLoad>& loads) {
  std::uint64_t count = loads.size();
  archive(count);
  loads.resize(count);
  for (auto& [node, force] : loads) archive(node, force);
}
template <class Archive>
void serialize(Archive& archive, ShellLoad& load) {
  auto& [shell, traction, strain] = load;
  archive(shell, traction, strain);
}
template <class Archive>
void serialize(Archive& archive, Settlement& settlement) {
  auto& [node, component, value] = settlement;
  archive(node, component, value);
}
template <class Archive>
void serialize(Archive& archive, LoadSet& loads) {
  auto& [nodes, beams, shells, settlements] = loads;
  archive_node_loads(archive, nodes);
  archive(beams, shells, settlements);
}

template <class Archive>
void serialize(Archive& archive, Mechanism& mechanism) {
  auto& [nodes, motion, beams] = mechanism;
  archive(nodes, motion, beams);
}
template <class Archive>
void serialize(Archive& archive, SolveQuality& quality) {
  auto& [backward_error, condition, error_bound, refinements, converged] = quality;
  archive(backward_error, condition, error_bound, refinements, converged);
}
template <class Archive>
void serialize(Archive& archive, ReanalysisAnswer& answer) {
  auto& [stable, mechanism, nearly_unstable, quality] = answer;
  archive(stable, mechanism, nearly_unstable, quality);
}
template <class Archive>
void serialize(Archive& archive, SelectiveEffort& effort) {
  auto& [selective, visited_entries, factor_entries, beams, shells, energy, energy_left_out, largest_left_out] = effort;
  archive(selective, visited_entries, factor_entries, beams, shells, energy, energy_left_out, largest_left_out);
}
template <class Archive>
void serialize(Archive& archive, ReanalysisCounters& counters) {
  auto& [solves, unchanged, load_solves, low_rank, refactorisations, orderings, background_factors, late_factors,
         selective, beams_visited, beams_left] = counters;
  archive(solves, unchanged, load_solves, low_rank, refactorisations, orderings, background_factors, late_factors,
          selective, beams_visited, beams_left);
}

template <class Archive>
void serialize(Archive& archive, RayleighDamping& damping) {
  auto& [mass, stiffness] = damping;
  archive(mass, stiffness);
}
template <class Archive>
void serialize(Archive& archive, DynamicEnergy& energy) {
  auto& [kinetic, elastic, damped, numerical, dissipated, struck, external_work, freed] = energy;
  archive(kinetic, elastic, damped, numerical, dissipated, struck, external_work, freed);
}
template <class Archive>
void serialize(Archive& archive, DynamicCounters& counters) {
  auto& [substeps, divided, retaken, breaks, yielding, changes, unsettled] = counters;
  archive(substeps, divided, retaken, breaks, yielding, changes, unsettled);
}
template <class Archive>
void serialize(Archive& archive, JointBreak& broken) {
  auto& [beam, end, time, forces] = broken;
  archive(beam, end, time, forces);
}
template <class Archive>
void serialize(Archive& archive, FrameDynamics::Impulse& struck) {
  auto& [node, impulse] = struck;
  archive(node, impulse);
}

}  // namespace topple::solver
