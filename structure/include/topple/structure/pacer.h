#pragma once
// A simulation on a thread of its own, at the pace of real time: for hosts that draw while it computes. The host's
// frame never waits for a step; it sees what moves between the last two states known, at its own time. Where steps take
// longer than they last, simulated time runs slower, never coarser, and ratio() tells by how much.
//
// When a tool comes in decides in which step it acts. For the same tools in the same steps, every pace gives the same
// bits: Simulation::save() holds them, whoever stepped.
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::structure {

/// A moving piece, as it is as long as it is there (BodyView without what changes).
struct PacedPiece {
  std::int64_t handle = -1;
  std::string name;
  Vec3 rest_centre = Vec3::Zero();  ///< a point p of a member moves to position + orientation (p - rest_centre)
  double mass = 0, radius = 0;      ///< kg; above zero: a sphere, m
  std::vector<MemberId> members;
  std::vector<PanelId> panels;
  std::shared_ptr<const fracture::Mesh> chunk;
  PieceKind chunk_of = PieceKind::slab;
};

/// What a host's frame sees.
struct PacedFrame {
  double time = 0;        ///< simulated, s; between the last two states
  std::int64_t step = 0;  ///< of the later of them
  bool at_rest = false, finished = false;
  std::vector<std::int64_t> handles;  ///< of the moving pieces, ascending
  std::vector<double> poses;          ///< seven for each, as Simulation::poses() has them: m, unit quaternion
  // Since the frame before:
  std::vector<PacedPiece> made;
  std::vector<std::int64_t> gone;
  std::vector<SimulationEvent> events;
  std::vector<HostImpulse> impulses;  ///< what bodies of the host felt, in the order of touch()
};

class Pacer {
 public:
  /// The simulation is the thread's alone from now on; it begins at once unless it is told to be `paused`.
  explicit Pacer(Simulation simulation, bool paused = false);
  /// Waits for the step under way.
  ~Pacer();

  // In: each acts in the step after the one under way.
  void apply(Tool tool);
  void touch(HostContact contact);
  /// Anything else, on the simulation's thread between two steps: queries, capacities, snapshots. What it changed of
  /// moving pieces is seen at once, also while paused. It must not keep references to the simulation.
  void order(std::function<void(Simulation&)> what);

  /// Out: to be called by one thread, once a frame. The reference holds until the next call.
  const PacedFrame& frame();

  // Pace.
  void set_paused(bool paused);
  [[nodiscard]] bool paused() const;
  /// Simulated seconds for each second, above 0; infinite: as fast as steps are made.
  void set_speed(double speed);
  [[nodiscard]] double speed() const;
  /// Simulated seconds for each second that there are: speed() while steps keep up, less while they do not (see
  /// StepThread::ratio()); 0 while paused or finished.
  [[nodiscard]] double ratio() const;
  /// Why the simulation stopped, when it or an order threw; empty otherwise.
  [[nodiscard]] std::string error() const;

  /// Ends the thread after the step under way and hands the simulation back, for hosts that go on by themselves.
  /// Nothing else may be asked afterwards.
  [[nodiscard]] Simulation stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
