// A game loop around a building: the simulation at its own pace, a car that the game owns, events as sound cues, poses
// for the renderer, and undo. Usage: example_game_loop [SECONDS]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unordered_map>

#include "topple/structure/formats/files.h"
#include "topple/structure/pacer.h"

using namespace topple::structure;

namespace {

/// What the game knows of a piece of debris: its handle lives as long as the piece.
struct Sprite {
  const double* pose = nullptr;  ///< seven numbers, owned by the frame
};

/// A car that the game's own engine drives straight on; the building only ever sees where it touches.
struct Car {
  Vec3 position{-12, 0, 0.8}, velocity{25, 0, 0};
  double mass = 1800, length = 4;
  bool crashed = false;

  void drive(double dt) { position += velocity * dt; }
  [[nodiscard]] HostContact at_bumper(MemberId post) const {
    HostContact contact;
    contact.key = 1;
    contact.member = post;
    contact.point = position + Vec3(length / 2, 0, 0);
    contact.normal = Vec3::UnitX();
    contact.mass = mass;
    contact.inertia = Vec3(800, 2500, 2800).asDiagonal();
    contact.centre = position;
    contact.velocity = velocity;
    return contact;
  }
};

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 4;
  auto [building, scenario] = read_scenario(find_scenario("seed_idle"));
  scenario.duration = 1e6;  // the game decides when it ends
  scenario.until_rest = false;
  Simulation simulation(std::move(building), std::move(scenario));
  const MemberId post = *NameIndex(simulation.building()).member("P-1-1-1");

  std::printf("what carries the corner slab:");
  for (const Carrier& carrier : simulation.what_carries(simulation.building().panels.empty() ? PanelId() : PanelId(0u)))
    std::printf(" %s (%.0f %%)", simulation.building()[carrier.joint].name.c_str(), 100 * carrier.share);
  for (const auto& [joint, used] : simulation.next_to_break(1))
    std::printf("\nnearest to breaking: %s at %.0f %%\n", simulation.building()[joint].name.c_str(), 100 * used.value);

  const Snapshot before = simulation.save();
  Car car;
  int cracks = 0;
  std::unordered_map<std::int64_t, Sprite> sprites;
  Pacer pacer(std::move(simulation));  // from here on it steps on a thread of its own
  double drawn = 0;
  while (drawn < seconds && pacer.error().empty()) {
    const PacedFrame& frame = pacer.frame();
    for (const SimulationEvent& event : frame.events)
      if (event.kind == SimulationEvent::Kind::joint_broke && ++cracks <= 3)
        std::printf("%6.2f s  crack at (%.1f, %.1f, %.1f)\n", event.time, event.position.x(), event.position.y(),
                    event.position.z());
    // The lists of what changed keep the game's own objects in step; nothing is searched for.
    for (const std::int64_t handle : frame.gone) sprites.erase(handle);
    for (const PacedPiece& piece : frame.made) sprites[piece.handle] = {};
    for (std::size_t i = 0; i < frame.handles.size(); ++i) sprites[frame.handles[i]].pose = &frame.poses[7 * i];
    for (const HostImpulse& felt : frame.impulses) {
      car.velocity += felt.impulse / car.mass;
      std::printf("%6.2f s  the car hits at %.1f m/s and goes on at %.1f m/s%s\n", frame.time, felt.speed_in,
                  felt.speed_out, felt.through ? ": the post is gone" : "");
    }
    // The game's own engine goes by the building's time, so that the two stay together where steps take long.
    car.drive(frame.time - drawn);
    drawn = frame.time;
    if (!car.crashed && car.position.x() + car.length / 2 >= -0.25) {
      pacer.touch(car.at_bumper(post));
      car.crashed = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(16));  // here the game draws
  }
  std::size_t finite = 0;
  for (const auto& [handle, sprite] : sprites) finite += sprite.pose != nullptr && sprite.pose[2] > -1;
  std::printf("%6.2f s  %zu pieces of debris, %d joints broken, at %.2f of real time\n", drawn, sprites.size(), cracks,
              pacer.ratio());
  if (cracks == 0 || sprites.empty() || finite != sprites.size()) return 1;

  simulation = pacer.stop();  // and from here on the game may step by itself
  simulation.restore(before);
  if (!simulation.frame().stands(post) || !simulation.bodies().empty()) return 1;
  std::printf("undone: it stands again\n");
  return 0;
}
