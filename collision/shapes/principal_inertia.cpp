#include "shapes/principal_inertia.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace topple::collision {

PrincipalInertia principal_inertia(const Mat3& inertia, const btTransform& tried, const std::string& owner) {
  constexpr double rounding = 1e-12;  // products of inertia below this share of the largest moment are taken as zero
  const double scale = inertia.diagonal().maxCoeff();
  const auto is_diagonal = [&](const Mat3& m) {
    return Mat3(m - Mat3(m.diagonal().asDiagonal())).cwiseAbs().maxCoeff() <= rounding * scale;
  };
  if (!inertia.allFinite() || !((inertia - inertia.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale)) {
    throw std::invalid_argument(owner + ": its inertia is not a finite symmetric matrix");
  }
  PrincipalInertia result;
  const Mat3 turn = from_bullet(tried.getBasis()), in_tried = turn.transpose() * inertia * turn;
  if (is_diagonal(in_tried)) {
    result.moments = in_tried.diagonal();
    result.axes = tried;
    result.turned = !(tried == btTransform::getIdentity());
  } else if (is_diagonal(inertia)) {
    result.moments = inertia.diagonal();
  } else {
    const Eigen::SelfAdjointEigenSolver<Mat3> solution(inertia);
    Mat3 axes = solution.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    result.moments = solution.eigenvalues();
    result.axes = btTransform(to_bullet(Eigen::Quaterniond(axes)));
    result.turned = true;
  }
  if (!(result.moments.minCoeff() > 0)) throw std::invalid_argument(owner + ": its inertia is not positive definite");
  return result;
}

}  // namespace topple::collision
