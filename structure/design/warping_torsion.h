#pragma once
// Warping torsion of doubly symmetric I sections: how a torque is shared between Saint-Venant's shear and the bending
// of the flanges. G J chi - E Iw chi'' = T with chi the twist per length, T the torque of the analysis (Vlasov,
// Thin-walled elastic beams; EN 1993-1-1 6.2.7, AISC Design Guide 9). Where torques are straight between stations the
// solution is exact.
#include <array>
#include <span>
#include <vector>

#include "design/steel_section.h"

namespace topple::structure {

struct WarpingForces {
  double bimoment = 0;        ///< -E Iw chi', N m2
  double uniform_torque = 0;  ///< G J chi: Saint-Venant's part
  double warping_torque = 0;  ///< the rest
};

/// At every station. `held`: whether warping is prevented at either end (chi = 0), or free (bimoment 0).
[[nodiscard]] std::vector<WarpingForces> warping_forces(const SteelSection& steel, std::span<const double> at,
                                                        std::span<const SectionForces> stations,
                                                        std::array<bool, 2> held);

/// For each station the largest absolute values of every end condition that may be: of the one that is given, or of all
/// four.
[[nodiscard]] std::vector<WarpingForces> worst_warping_forces(const SteelSection& steel, const DesignMember& member,
                                                              std::span<const SectionForces> stations);

/// What a bimoment and a warping torque do to an I section: normal stress at the flanges' tips, B (h - tf) b/4 / Iw,
/// and shear in the middle of a flange, 1.5 Tw/((h - tf) b tf).
[[nodiscard]] double warping_normal_stress(const SteelSection& steel, double bimoment);
[[nodiscard]] double warping_shear_stress(const SteelSection& steel, double warping_torque);
/// The largest of an axial force and both moments together, at a corner of the section.
[[nodiscard]] double elastic_normal_stress(const SteelSection& steel, const SectionForces& at);
/// The largest shear stress of Saint-Venant's part of a torque, in the thickest plate.
[[nodiscard]] double uniform_torsion_stress(const SteelSection& steel, double uniform_torque);

}  // namespace topple::structure
