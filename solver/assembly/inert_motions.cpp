#include "assembly/inert_motions.h"

namespace topple::solver {
namespace {

void drop_from(const DofMap& dofs, InertMotions::Kind kind, std::size_t node, const InertMotions::Node& inert,
               std::span<const double> scale, Eigen::VectorXd& values) {
  const auto k = static_cast<std::size_t>(kind);
  for (int i = 0; i < inert.count; ++i) {
    const Vec3 axis = inert.directions.col(i);
    double idle = 0;
    for (std::size_t c = 0; c < 3; ++c)
      if (const int e = dofs.number[node][3 * k + c]; e < dofs.equations)
        idle +=
            axis(static_cast<Eigen::Index>(c)) * values(e) * (scale.empty() ? 1 : scale[static_cast<std::size_t>(e)]);
    for (std::size_t c = 0; c < 3; ++c)
      if (const int e = dofs.number[node][3 * k + c]; e < dofs.equations)
        values(e) -=
            idle * axis(static_cast<Eigen::Index>(c)) / (scale.empty() ? 1 : scale[static_cast<std::size_t>(e)]);
  }
}

}  // namespace

void InertMotions::forget(std::size_t node) {
  for (std::size_t kind = 0; kind < of_.size(); ++kind) {
    if (of_[kind][node].count > 0) --counts_[kind];
    of_[kind][node].count = 0;
  }
}

void InertMotions::add(Kind kind, std::size_t node, const Vec3& direction, double stiffness) {
  Node& inert = of_[static_cast<std::size_t>(kind)][node];
  if (inert.count == 0) ++counts_[static_cast<std::size_t>(kind)];
  inert.directions.col(inert.count++) = direction;
  inert.stiffness = stiffness;
}

void InertMotions::add_stiffness(std::size_t node, Mat6& K) const {
  for (const Kind kind : kinds) {
    const Node& inert = of(kind, node);
    const auto first = static_cast<Eigen::Index>(3 * static_cast<std::size_t>(kind));
    for (int k = 0; k < inert.count; ++k) {
      const Vec3 d = inert.directions.col(k);
      K.block<3, 3>(first, first) += inert.stiffness * d * d.transpose();
    }
  }
}

void InertMotions::drop(const DofMap& dofs, std::span<const double> scale, Eigen::VectorXd& values) const {
  for (const Kind kind : kinds) {
    if (!any(kind)) continue;
    for (std::size_t node = 0; node < dofs.number.size(); ++node)
      drop_from(dofs, kind, node, of(kind, node), scale, values);
  }
}

}  // namespace topple::solver
