#pragma once
// Every constant of the contact solver: unit, reason, effect.

namespace topple::collision {

struct SolverSettings {
  // Sub-steps. A contact is a spring whose rate is its effective mass times (2 pi f)^2 with f = 1/(stiffness h): under
  // a load of R times the weight of that mass it rests R g/(2 pi f)^2 deep.
  double stiffness = 4;            ///< sub-steps in a period: with fewer, passes over the contacts do not converge
  double damping = 10;             ///< ratio: overlaps are pushed apart without bouncing
  double standing_stiffer = 2;     ///< f against what stands, times this: nothing there gives way
  double standing_damping = 0.5;   ///< and the damping ratio
  int fewest_substeps = 4;         ///< of a step: below, friction and stacks of two creep
  int most_substeps = 64;          ///< of a step: a thousandfold mass needs 40
  double substeps_for_weight = 8;  ///< of a 1/60 s step, for a contact that bears the weight of its own mass ...
  double substeps_growth = 0.07;   ///< ... times the load over that weight to this power: a stack of ten rests within
                                   ///< 0.3 mm, a hundredfold mass within 2 mm, a thousandfold within 15
  double substep_way = 0.0025;  ///< m that an island's bodies go in a sub-step at most, root mean square: what falls on
                                ///< a heap as a whole is else pressed into it by the way of many sub-steps
  double substeps_held = 0.7;   ///< their number falls only when the load asks for less than this share of it
  double pushed_apart = 3;  ///< m/s: overlaps are undone no faster (chunks are born inside each other). What is pressed
                            ///< in by a thousandfold mass needs 2.5: held below that, a spring does not bear its load

  int moving_passes = 2;  ///< at least one, of a sub-step in which overlaps are pushed apart: stacks of ten rest within
                          ///< 0.3 mm. More where it does not `settle`: a beam under slabs would be pressed into them
  double settled = 0.3;   ///< m/s: passes are repeated in a sub-step that changes a contact's speed by more
  int most_passes = 100;  ///< in a sub-step: an impact through a stack of that many comes through

  int contacts_of_domain = 256;  ///< a heap with twice as many is cut into domains that threads can take, so that four
                                 ///< contacts fill each pack; passes go through it in another order then
  int most_domains = 16;         ///< of a heap: threads beyond these find nothing to do in it

  double spins_by = 5;  ///< rad/s: where what angular momentum lacks would turn a body faster, both turn alike

  double leaves_plane = 0.02;  ///< m: a step is taken in parts where a body that touches leaves the planes of its
                               ///< contacts by more as it spins
  int most_parts = 16;         ///< of a step: a post 4 m long that turns half around in a step needs 15

  // Contacts.
  double margin = 0.02;  ///< m: parts nearer than this are looked at as contacts about to be
  double kept = 0.005;   ///< m: contacts are sought anew when a point of the pair has moved farther against the other
  double matched = 0.1;  ///< m: a new point takes over the impulse of an old one nearer than this
  double fat = 0.04;     ///< m by which bounds are larger than parts: pairs are sought again beyond it
  double restitution_from = 1;  ///< m/s: slower contacts do not bounce, so that piles come to rest
  double patch = 0.0025;     ///< m: radius of what touches at a point. Rolling is braked at 1 mm: handbooks have levers
                             ///< of rolling friction of 0.5 mm (steel on steel) to 1.5 (wood on wood). Without it what
                             ///< hangs on edges swings for ever. Larger: it comes to rest sooner
  double rolls_from = 0.02;  ///< rad/s: slower rolling is braked in proportion. A post's end goes 0.04 m/s at that
  double rolling_resistance = 0.1;  ///< of the normal force times the radius, a ball on soil: it would roll for ever

  // What stands and moves.
  /// How much a force on it has to change, squared, as a share of it, before its motion tells by how much it gives way:
  /// what else moves it counts as much else. Decides how soon forces on it settle, not on what.
  double telling_change = 0.25;
  /// Of what it is taken to give way by at first (ObstacleMotion::mass): the least and the most that its motion may
  /// tell. The most has to be above what several that act on one light part make of it, or their forces grow from one
  /// part of a step to the next.
  double gives_way_least = 0.02, gives_way_most = 8;

  // Joints.
  double joint_frequency = 120;  ///< Hz at most (a quarter of the sub-steps' rate): gaps of hinges close with it
  double joint_damping = 2;      ///< ratio

  // Rest.
  double slow = 0.05;        ///< m/s, mean over `slow_for` of the farthest point: a body that is slower ...
  double slow_for = 0.5;     ///< s: ... for so long, and all that touch it, sleep
  double struck_from = 0.1;  ///< m/s: what sleeps is woken before it is come upon faster than this
  /// m/s: what lies on something that stands and moves faster is awake. A building that swings once in a second goes
  /// on by 1.6 mm at that, which is about as near as points `touch`.
  double carries_from = 0.01;
  double wakes_from = 0.1;  ///< of its weight: what sleeps wakes when a force on it changes by more ...
  double pressed_over =
      0.1;  ///< s: ... averaged over this: an impact wakes from a speed of 0.1 m/s, as `struck_from` does
  double touching = 0.001;    ///< m: points that are nearer bear at rest
  double equilibrium = 1e-6;  ///< of a body's weight (moments: times its size): what sleeps is out of balance by less
  int equilibrium_passes = 6000;  ///< over the contacts in the search for that balance, at most
  int rest_searches = 6;   ///< for a balance of an island, each without the bodies that no forces held in the last ...
  double left_out = 0.05;  ///< ... which are no more than this share of the others: one slab that rocks on a heap does
                           ///< not keep the heap awake
  double rest_again = 0.25;       ///< s: where no balance was found, it is sought again after this, then twice this ...
  double rest_again_at_most = 2;  ///< s: ... and so on to this, until something moves: what is sought in vain is dear
};

/// m. Of a patch that gives and does not spring back the front half alone bears where it rolls, with its middle there.
[[nodiscard]] constexpr double rolling_lever(const SolverSettings& settings) {
  return 4 / (3 * 3.14159265358979323846) * settings.patch;
}
/// m. Of friction on a patch that is pressed evenly and spins.
[[nodiscard]] constexpr double spin_lever(const SolverSettings& settings) { return 2.0 / 3 * settings.patch; }

#ifdef TOPPLE_VARIED_CONSTANTS  // benchmarks/constants: each halved and doubled
inline SolverSettings solver_settings{};
#else
inline constexpr SolverSettings solver_settings{};
#endif

}  // namespace topple::collision
