#pragma once
// Dust where things break and land, sparks where steel does, fire and smoke where a fire is laid or a charge goes off.
// A puff is an event with a place and a size; what is seen of it is a function of its age alone, so that a run looked
// back at shows the dust that it showed when it ran.
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <vector>

#include "renderer/shapes/looks.h"
#include "renderer/shapes/palette.h"
#include "renderer/snapshot.h"

namespace topple::viewer {

/// A puff is gone when it is this old, s.
inline constexpr double dust_life = 5;
/// What drifts is carried by a light breeze, m/s (2 on Beaufort's scale begins at 1.6).
inline constexpr float wind[2] = {1.3F, 0.7F};

/// What burns for some time: flames and smoke, or where `kind` is sparks, a shower of them.
struct LaidFire {
  std::vector<structure::MemberId> members;  ///< in their middles, wherever these are by then
  std::vector<structure::JointId> joints;    ///< of members; where they are
  double from = 0, until = 0;                ///< s
  DustPuff::Kind kind = DustPuff::Kind::fire;
};

/// Watches one simulation, step after step, for what throws dust up.
class DustWatcher {
 public:
  void burn(LaidFire fire) { fires_.push_back(std::move(fire)); }
  /// Something burns at this time, s.
  [[nodiscard]] bool burns(double time) const;
  /// A charge goes off: kg of TNT.
  void blast(const Eigen::Vector3d& centre, double charge);
  /// Puffs that are not gone yet, in order of time; null: none. The same pointer as before when nothing changed.
  [[nodiscard]] std::shared_ptr<const std::vector<DustPuff>> watch(const structure::Simulation& simulation);

 private:
  struct Seen {
    Eigen::Vector3d position, velocity;
  };
  void hear(const structure::Simulation& simulation);
  void find_landings(const structure::Simulation& simulation);
  /// Of what it is made: dust of its colour; sparks where it is steel.
  void throw_up(DustPuff puff, Look look);
  void burn_on(const structure::Simulation& simulation);
  void fire_at(const Eigen::Vector3d& place, double time, double size, DustPuff::Kind kind);
  /// What it is made of, and its mass, by the name of a part, joint or chunk.
  struct Stuff {
    Look look = Look::concrete;
    double mass = 0;
  };
  [[nodiscard]] Stuff stuff_of(const structure::Building& building, const std::string& name);
  void hear_impact(const structure::Building& building, const structure::SimulationEvent& event);

  std::vector<DustPuff> puffs_;
  std::vector<DustPuff> blasts_;  ///< that have gone off since the last look
  std::vector<LaidFire> fires_;
  std::shared_ptr<const std::vector<DustPuff>> shared_;
  std::map<std::int64_t, Seen> bodies_;
  std::unique_ptr<structure::NameIndex> names_;
  std::size_t events_heard_ = 0;
  std::int64_t thrown_up_ = 0;
  double time_ = 0;
  bool changed_ = false;
};

/// One soft disc that faces the eye.
struct DustInstance {
  glm::vec3 position;  ///< relative to the origin given
  float radius;
  float opacity;
  Rgba colour;  ///< alpha: how far it glows by itself
  float seed;   ///< 0 to 1: tells its noise from others'
};
/// J, of the impact that throws up a cloud of this size.
[[nodiscard]] double energy_of(const DustPuff& puff);
/// What is seen of the puffs at an instant.
void append_dust(const std::vector<DustPuff>& puffs, double time, const glm::dvec3& origin,
                 std::vector<DustInstance>& instances);

}  // namespace topple::viewer
