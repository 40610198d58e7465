#include "bullet/library_check.h"

#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btPoolAllocator.h>

#include <stdexcept>
#include <string>

namespace topple::collision {

static_assert(sizeof(btScalar) == sizeof(double), "compile Bullet's headers with BT_USE_DOUBLE_PRECISION");

void require_double_precision_library() {
  // The constructor is compiled in the library and lays out a pool of elements of the library's own size.
  btDefaultCollisionConfiguration configuration;
  const int in_library = configuration.getPersistentManifoldPool()->getElementSize();
  constexpr int in_headers = sizeof(btPersistentManifold);
  if (in_library != in_headers) {
    throw std::runtime_error("Bullet: the linked library has objects of " + std::to_string(in_library) +
                             " bytes where its headers say " + std::to_string(in_headers) +
                             "; link the double precision one (pkg-config bullet-float64)");
  }
}

}  // namespace topple::collision
