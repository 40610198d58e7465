#include "analysis/natural_modes.h"

#include <algorithm>
#include <cmath>

#include "analysis/divided_member.h"
#include "analysis/instability.h"
#include "analysis/largest_displacement.h"
#include "analysis/motion/modal_masses.h"
#include "analysis/one_way_members.h"
#include "analysis/undivided_members.h"
#include "mesh/frame_mesh.h"
#include "mesh/semi_rigid_elements.h"
#include "topple/solver/shifted_modes.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

solver::ModalAnswer modes_of(const ModalStructure& of, const solver::FrameModel& model, const solver::MassModel& masses,
                             const solver::AxialState* tangent) {
  const AnalysisRequest& request = of.request;
  try {
    if (!of.floats) return solver::natural_modes(model, masses, request.modes, request.solver, tangent);
    return solver::shifted_modes(model, masses, request.modes, of.building.requested.frequency_shift, request.solver,
                                 tangent);
  } catch (const solver::UnresolvedModes& unresolved) {
    throw InputError(describe_unresolved(of.building, unresolved));
  }
}

}  // namespace

void find_natural_modes(const ModalStructure& structure, const std::optional<ModalTangent>& tangent,
                        AnalysisResult& result) {
  const auto& [building, request, whole, edges, jointed, floats] = structure;
  Frame frame = whole;
  if (tangent) frame.model.beams = tangent->beams;
  if (request.divide > 1) result.mode_cuts = divide_evenly(building, request.divide, frame);
  solver::MassModel masses{request.mass,
                           request.torsional_mass,
                           request.rotary_inertia,
                           modal_masses(building, frame, edges, request.divide > 1),
                           mass_lengths(building, frame),
                           jointed};
  const solver::FrameModel model = carrying_both(frame.model);
  const solver::AxialState state = tangent ? divided_state(whole, frame, tangent->state) : solver::AxialState();
  solver::ModalAnswer answer = modes_of(structure, model, masses, tangent ? &state : nullptr);
  result.modes = std::move(answer.modes);
  for (solver::VibrationMode& mode : result.modes) scale_to_largest(building, whole, result.mode_cuts, mode.shape);
  result.moving_mass = answer.moving_mass;
  if (static_cast<int>(result.modes.size()) < request.modes)
    result.warnings.push_back("the masses have " + std::to_string(result.modes.size()) + " modes, " +
                              std::to_string(request.modes) + " were asked for");
  // Frame3DD's files ask for modes themselves, and for elements as they are.
  if (building.requested.modes > 0) return;
  if (std::string told = told_undivided(building, frame, result.modes); !told.empty())
    result.warnings.push_back(std::move(told));
}

void scale_to_largest(const Building& building, const Frame& frame, const std::vector<std::vector<int>>& cuts,
                      std::vector<Vec6>& shape) {
  make_shape_absolute(frame, shape);
  const double largest = largest_in_shape(building, shape, cuts);
  double most = 0;
  for (const Vec6& motion : shape) most = std::max(most, motion.cwiseAbs().maxCoeff());
  constexpr double noise = 1e-12;
  for (Vec6& motion : shape)
    for (double& component : motion) {
      if (std::abs(component) < noise * most) component = 0;
      if (largest > 0) component /= largest;
    }
}

}  // namespace topple::structure
