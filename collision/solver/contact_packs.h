#pragma once
// Contacts of four pairs of bodies side by side, as the solver's inner loops read them: plain numbers, no body twice in
// a pack. Packs are done in their order, and side by side where they share no body (ContactDomains).
//
// Velocities and displacements are scaled by the roots of mass and moments: a row's Jacobian is then its own mass
// matrix times itself, and half of what would be read is not there. For a body with mass m and principal moments I,
//   v^ = sqrt(m) v,   w^ = sqrt(I) R' w,   row on w^: R' (r x n)/sqrt(I).
#include <cstddef>
#include <vector>

// Such vectors never cross a call that is not inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace topple::collision {

inline constexpr int kLanes = 4;
typedef double Wide __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

struct alignas(32) PackWide {
  Wide value;
};

/// Of a body in the sub-steps: scaled velocity, or displacement since the step began.
struct alignas(64) Motion6 {
  double linear[3]{}, angular[3]{}, unused[2]{};  ///< read as two rows of four
};
static_assert(sizeof(Motion6) == 64);

/// One point of each lane.
struct alignas(32) PackPoint {
  Wide first[3], second[3];  ///< angular parts of the normal row
  Wide separation;           ///< when the step began
  Wide apart;                ///< when the sub-step began
  Wide mass;                 ///< effective, of the row; 0: no point in this lane
  Wide impulse;              ///< of this sub-step
  Wide total;                ///< over the step
  Wide parting;              ///< impulse of this sub-step and what pushes an overlap apart
  Wide approach;             ///< relative speed along the normal when the step began, negative when closing
};

struct alignas(32) ContactPack {
  int first_body[kLanes]{}, second_body[kLanes]{};  ///< 0: what stands
  std::size_t first_point = 0;
  int point_count = 0;
  bool apart_from_next = false;  ///< no body is in this pack and in the next
  Wide normal[3];
  Wide first_root, second_root;  ///< 1/sqrt(mass)
  Wide bias_rate, mass_scale, impulse_scale;
  Wide restitution;
  // Friction of the patch, at its centre: two directions across the normal, and the turn about it.
  Wide along[2][3];
  Wide along_first[2][3], along_second[2][3];
  Wide twist_first[3], twist_second[3];
  Wide inverse[3];  ///< of the two directions' mass matrix: xx, xy, yy
  Wide twist_mass;
  Wide friction;
  Wide lever;                        ///< m: a twist counts as so much force
  Wide spins_at;                     ///< m: where it is bounded by itself, as that of a patch: by how much; else 0
  Wide slide[2], twist;              ///< impulses of this sub-step
  Wide slide_total[2], twist_total;  ///< over the step
  Wide carried,
      slide_carried[2];  ///< sums of what had been applied whenever bodies were moved: along the normal, across
};

/// Passes that are repeated in a sub-step, as long as an impact goes on through a stack: each goes on the way of those
/// before it, by the rule of Fletcher and Reeves (Silcowitz, Niebe and Erleben, Vis. Comput. 26, 2010).
struct Again {
  double settled = 0;      ///< m/s: a pass that changes no point's speed by more is the last
  Wide* change = nullptr;  ///< of each point's impulse in the last pass; null: not kept
  Wide* way = nullptr;     ///< of each point
  Wide* energy = nullptr;  ///< J, of each point: its change's square over its mass; written where changes are
  double share = 0;        ///< of the way that is gone on
  const unsigned char* moved = nullptr;  ///< of each body: the pass before has changed it; null: all may have been
  unsigned char* moves = nullptr;        ///< of each body: this pass changes it
};

struct SubStep {
  double length = 0;        ///< s
  double pushed_apart = 0;  ///< m/s
  double restitution_from = 0;
  const Again* again = nullptr;
  bool first = false;  ///< pass of its kind in the sub-step
};

/// The inner loops, in the widest instructions that the processor has; the bits are the same in all.
/// A pass over packs sums nothing, so that threads may share it: whether a point has changed by more than `settled` is
/// returned.
struct ContactKernels {
  using Pass = bool (*)(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
                        const Motion6* displacement, const SubStep& step);
  Pass warm_start;  ///< applies the impulses that the packs hold
  Pass solve;       ///< normal rows; the first looks how far points are apart now
  Pass go_on;       ///< goes on the way of the last passes
  Pass relax;       ///< normal rows, then friction
  Pass separate;    ///< normal rows with the springs: nothing but `parting` changes. The first adds up the totals
  Pass restitute;   ///< after the last sub-step
};
[[nodiscard]] const ContactKernels& contact_kernels();
/// All that this processor can run, the plainest first.
[[nodiscard]] std::vector<const ContactKernels*> usable_contact_kernels();

}  // namespace topple::collision
