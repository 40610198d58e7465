#pragma once
// Contacts of a near pair from step to step: carried along while the two hardly move against each other, sought anew
// when they do; new points take over the impulses of old ones.
#include "contacts/near_pairs.h"

namespace topple::collision {

struct PairMotion {
  const PartShape *first = nullptr, *second = nullptr;  ///< second null: the ground
  const Placement *first_at = nullptr, *second_at = nullptr;
  double margin = 0;  ///< m: what is nearer is told
  double ground_height = 0;
};

/// `kept`: m by which a point of the second may move against the first; `matched`: m between an old and a new point.
/// Returns m that the two may come together and still be no nearer than zero, at least; 0 where they touch or none is
/// known.
double update_contacts(NearPair& pair, const PairMotion& motion, double kept, double matched);

}  // namespace topple::collision
