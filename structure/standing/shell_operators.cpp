#include "standing/shell_operators.h"

#include "topple/solver/shell_resultants.h"
#include "topple/solver/superelement.h"

namespace topple::structure {

namespace {

ShellOperators::Element operators_of(const solver::FrameModel& alone) {
  ShellOperators::Element element;
  for (int axis = 0; axis < 3; ++axis) {
    const std::array<Vec6, 4> own = solver::traction_loads(alone, 0, Vec3::Unit(axis));
    for (int n = 0; n < 4; ++n) element.loads.col(axis).segment<6>(6 * n) = own[static_cast<std::size_t>(n)];
  }
  element.mass = solver::shell_mass(alone, 0, 1);
  for (int i = 0; i < 4; ++i)  // along x, as along any axis
    for (int j = 0; j < 4; ++j) element.area += element.mass(6 * i, 6 * j);
  for (int freedom = 0; freedom < 24; ++freedom) {
    std::vector<Vec6> u(4, Vec6::Zero());
    u[static_cast<std::size_t>(freedom / 6)](freedom % 6) = 1;
    const solver::ShellResultants r = solver::shell_resultants(alone, 0, u);
    element.resultants.col(freedom) << r.membrane, r.moments;
  }
  return element;
}

}  // namespace

const ShellOperators::Element& ShellOperators::of(const solver::Shell& shell, const std::vector<Vec3>& nodes) {
  solver::FrameModel alone;
  alone.shells = {shell};
  const Vec3& origin = nodes[static_cast<std::size_t>(shell.node[0])];
  for (std::size_t i = 0; i < 4; ++i) {
    alone.nodes.push_back(nodes[static_cast<std::size_t>(shell.node[i])] - origin);
    alone.shells[0].node[i] = static_cast<int>(i);
  }
  std::array<double, 13> key{shell.youngs_modulus, shell.poisson_ratio, shell.thickness, shell.bending ? 1.0 : 0.0};
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) key[1 + 3 * i + c] = alone.nodes[i](static_cast<Eigen::Index>(c));
  const auto found = elements_.find(key);
  return found != elements_.end() ? found->second : elements_.emplace(key, operators_of(alone)).first->second;
}

}  // namespace topple::structure
