#pragma once
// The principal moments and axes of a body.
#include <string>

#include "bullet/bullet_types.h"

namespace topple::collision {

struct PrincipalInertia {
  Vec3 moments;
  btTransform axes = btTransform::getIdentity();
  bool turned = false;  ///< the axes are not those of the description
};

/// `tried`: axes that are taken where they are principal ones. Throws std::invalid_argument, naming `owner`, for an
/// inertia that is not symmetric, finite and positive definite.
[[nodiscard]] PrincipalInertia principal_inertia(const Mat3& inertia, const btTransform& tried,
                                                 const std::string& owner);

}  // namespace topple::collision
