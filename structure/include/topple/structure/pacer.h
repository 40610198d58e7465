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
  std::int64_t handle = -1;         ///< as Simulation has it
  std::string name;                 ///< of its first member, else panel, chunk or ball
  Vec3 rest_centre = Vec3::Zero();  ///< a point p of a member moves to position + orientation (p - rest_centre)
  double mass = 0;                  ///< kg
  double radius = 0;                ///< m; above zero: a sphere
  std::vector<MemberId> members;    ///< that it is made of
  std::vector<PanelId> panels;      ///< that it is made of
  std::shared_ptr<const fracture::Mesh> chunk;  ///< as BodyView has it; null for other pieces
  PieceKind chunk_of = PieceKind::slab;         ///< what it is a piece of
};

/// What a host's frame sees.
struct PacedFrame {
  double time = 0;                    ///< simulated, s; between the last two states
  std::int64_t step = 0;              ///< of the later of them
  bool at_rest = false;               ///< nothing moves
  bool finished = false;              ///< no further step will be made
  std::vector<std::int64_t> handles;  ///< of the moving pieces, ascending
  std::vector<double> poses;          ///< seven for each, as Simulation::poses() has them: m, unit quaternion
  // Since the frame before:
  std::vector<PacedPiece> made;         ///< pieces that came
  std::vector<std::int64_t> gone;       ///< handles of pieces that went
  std::vector<SimulationEvent> events;  ///< in order
  std::vector<HostImpulse> impulses;    ///< what bodies of the host felt, in the order of touch()
};

/// A simulation that runs by itself. All but frame() may be called from any thread.
class Pacer {
 public:
  /// The simulation is the thread's alone from now on; it begins at once unless it is told to be `paused`.
  explicit Pacer(Simulation simulation, bool paused = false);
  /// Waits for the step under way.
  ~Pacer();

  // In: each acts in the step after the one under way.
  /// A tool, as Simulation::apply().
  void apply(Tool tool);
  /// A contact of the host's, as Simulation::touch().
  void touch(HostContact contact);
  /// Anything else, on the simulation's thread between two steps: queries, capacities, snapshots. What it changed of
  /// moving pieces is seen at once, also while paused. It must not keep references to the simulation.
  void order(std::function<void(Simulation&)> what);

  /// Out: to be called by one thread, once a frame. The reference holds until the next call.
  const PacedFrame& frame();

  // Pace.
  /// Stops before the next step, or goes on.
  void set_paused(bool paused);
  /// As it was last set.
  [[nodiscard]] bool paused() const;
  /// Simulated seconds for each second, above 0; infinite: as fast as steps are made.
  void set_speed(double speed);
  /// As it was last set.
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
