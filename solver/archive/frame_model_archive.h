#pragma once
// Models of frames and of their masses as bytes, whole (state_archive.h).
#include "description_archive.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/modes.h"

namespace topple::solver {

template <class Archive>
void serialize(Archive& archive, Beam& beam) {
  auto& [node, offset, axes, length, youngs_modulus, shear_modulus, area, shear_area_y, shear_area_z, Iy, Iz, J,
         density, end_stiffness, axial] = beam;
  archive(node, offset, axes, length, youngs_modulus, shear_modulus, area, shear_area_y, shear_area_z, Iy, Iz, J,
          density, end_stiffness, axial);
}

template <class Archive>
void serialize(Archive& archive, Shell& shell) {
  auto& [node, youngs_modulus, poisson_ratio, thickness, density, bending] = shell;
  archive(node, youngs_modulus, poisson_ratio, thickness, density, bending);
}

template <class Archive>
void serialize(Archive& archive, Support& support) {
  auto& [node, stiffness] = support;
  archive(node, stiffness);
}

template <class Archive>
void serialize(Archive& archive, Diaphragm& diaphragm) {
  auto& [nodes] = diaphragm;
  archive(nodes);
}

template <class Archive>
void serialize(Archive& archive, Patch& patch) {
  auto& [node, stiffness, mass] = patch;
  archive(node, stiffness, mass);
}

template <class Archive>
void serialize(Archive& archive, FrameModel& model) {
  auto& [nodes, beams, shells, supports, diaphragms, shell_stiffness, patches] = model;
  archive(nodes, beams, shells, supports, diaphragms, shell_stiffness, patches);
}

template <class Archive>
void serialize(Archive& archive, NodeMass& mass) {
  auto& [node, own, inertia] = mass;
  archive(node, own, inertia);
}

template <class Archive>
void serialize(Archive& archive, JointedShell& shell) {
  auto& [number, patch, corners] = shell;
  archive(number, patch, corners);
}

template <class Archive>
void serialize(Archive& archive, MassModel& masses) {
  auto& [distribution, torsional, rotary_inertia, nodes, beam_lengths, jointed] = masses;
  archive(distribution, torsional, rotary_inertia, nodes, beam_lengths, jointed);
}

}  // namespace topple::solver
