#pragma once
// A frame in free fall and a ball that flies at it, at random: the way between them is straight, so that where and how
// fast they meet does not hang on the length of the step.
#include <cmath>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include "simulation_run.h"
#include "support/scratch_folder.h"
#include "topple/structure/formats/files.h"

namespace topple::test {

using namespace topple::structure;

inline std::string vec(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  return text.str();
}

/// A mast with arms in random directions, high above the ground, and a ball that flies at one of them. Both fall alike,
/// so that the way between them is straight.
struct Meeting {
  std::string model, events;
};

inline Meeting random_meeting(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const int arms = 2 + static_cast<int>(3 * unit(random));
  const double thickness = 0.006 + 0.01 * unit(random), strength = std::pow(10, -1 + 2.5 * unit(random));
  std::ostringstream nodes, members;
  nodes.precision(17);
  const Vec3 rigid_end(0, 0, 60);
  nodes << R"("F": [0, 0, 54], "H": [0, 0, 60])";
  members << R"("PM": {"kind": "post", "nodes": ["F", "H"], "section": "tube", "material": "S355"})";
  std::vector<Vec3> ends;
  for (int i = 0; i < arms; ++i) {
    const double turn = 2 * M_PI * (i + 0.5 * unit(random)) / arms;
    const Vec3 end =
        rigid_end + Vec3(std::cos(turn), std::sin(turn), unit(random) - 0.5).normalized() * (2 + 3 * unit(random));
    ends.push_back(end);
    nodes << ", \"E" << i << "\": " << vec(end);
    members << ", \"B" << i << R"(": {"nodes": ["H", "E)" << i
            << R"("], "section": "tube", "material": "S355", "joints": ["weak", null]})";
  }
  Meeting meeting;
  std::ostringstream model;
  model.precision(17);
  model
      << R"({"topple": 1, "title": "Mast", "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.2, "width": 0.2, "thickness": )"
      << thickness << R"(}},
 "joints": {"weak": {"capacity": {"tension": 1e6, "compression": 1e6, "shear_y": 3e5, "shear_z": 3e5, "torsion": 5e4,
                                  "moment_y": 6e4, "moment_z": 6e4}, "strength": )"
      << strength << R"(}},
 "nodes": {)"
      << nodes.str() << R"(}, "members": {)" << members.str() << R"(}, "supports": {"F": "fixed"}})";
  meeting.model = model.str();
  // The frame is let go four thirtieths before the ball comes: it falls faster by that.
  const double speed = 4 + 26 * unit(random), mass = 500 * std::pow(10, 1.5 * (unit(random) - 0.7));
  const Vec3 target = rigid_end + (0.3 + 0.6 * unit(random)) * (ends[0] - rigid_end);
  Vec3 along = Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5).normalized();
  const Vec3 arm = (ends[0] - rigid_end).normalized();
  along = (along - 0.7 * along.dot(arm) * arm).normalized();
  const Vec3 fall(0, 0, -9.80665 * 4 / 30);
  std::ostringstream events;
  events.precision(17);
  events << R"([{"at": 0.1, "remove": {"supports": ["F"]}}, {"at": )" << 7.0 / 30 << R"(, "projectile": {"from": )"
         << vec(target - 6 * along) << R"(, "velocity": )" << vec(speed * along + fall) << R"(, "mass": )" << mass
         << R"(, "radius": 0.2}}])";
  meeting.events = events.str();
  return meeting;
}

/// What came of it. The first impact in which something broke, and all that broke in the end.
struct MeetingOutcome {
  bool broke = false;
  std::set<std::string> joints;
  double peak_force = 0;  ///< N
  std::size_t broken_in_all = 0;
  double momentum_error = 0;
};

/// In steps of this length, s.
inline MeetingOutcome meet(const Meeting& meeting, double step) {
  const ScratchFolder folder;
  std::ofstream(folder / "mast.json") << meeting.model;
  std::ostringstream scenario_text;
  scenario_text.precision(17);
  scenario_text
      << R"({"topple": 1, "model": "mast.json", "standing": "static", "ground": 0.0, "duration": 2.2, "until_rest": false, "failure": {"bracing": "none"}, "step": )"
      << step << R"(, "events": )" << meeting.events << "}";
  auto [building, scenario] = parse_scenario(scenario_text.str(), "s.json", folder.path());
  Simulation simulation(std::move(building), std::move(scenario));
  run(simulation);
  MeetingOutcome first;
  bool in_first = false;
  for (const SimulationEvent& event : simulation.events()) {
    if (event.kind == SimulationEvent::Kind::impact) {
      in_first = !first.broke;
      if (in_first) first.peak_force = event.peak_force;
      first.broke = true;
    }
    if (event.kind != SimulationEvent::Kind::joint_broke) continue;
    ++first.broken_in_all;
    if (in_first) first.joints.insert(event.name);
  }
  first.momentum_error = simulation.ledger().momentum_error;
  return first;
}

}  // namespace topple::test
