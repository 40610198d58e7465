#pragma once
// The tool that a person has in hand, and how each is set.
#include <array>
#include <string>

namespace topple::viewer {

struct Shot {
  double speed = 60, mass = 500, radius = 0.4;  ///< m/s, kg, m
};
/// A ball on a cable that swings into what is clicked on: let go with the cable taut, at this angle from straight down.
struct Swing {
  double cable = 12, angle = 1.2;  ///< m; rad, up to a quarter turn
  double mass = 5000, radius = 0.9;
};
/// A fire around what is clicked on: what is left of the joints' strength and of the members' stiffness at its end.
struct Burning {
  double reach = 4, over = 30;  ///< m; s
  double strength = 0.15, stiffness = 0.2;
};
inline constexpr int burning_stages = 10;

/// A rope from what is clicked on to a winch on the ground, on the side of the eye.
struct Hauling {
  double force = 500e3, over = 5;  ///< N; s
};
/// What shakes the ground: a file of its accelerations, or where there is none, a computed motion.
struct Shake {
  double peak = 5, over = 12;  ///< m/s2; s
  std::string file;            ///< as `topple analyse --time-history` reads it
};

/// What a click does.
enum class ToolKind { fire, swing, cut, remove, support, charge, explosion, burn, thermite, hook, path, select };
inline constexpr std::array<const char*, 12> tool_names{"fire",           "wrecking ball", "cut joint", "remove part",
                                                        "remove support", "charge",        "explosion", "burn",
                                                        "thermite",       "hook",          "load path", "select"};

struct Hand {
  ToolKind tool = ToolKind::fire;
  Shot shot;
  Swing swing;
  Burning burning;
  Hauling hauling;
  Shake shaking;
  double charge_radius = 6;  ///< m; within it joints lose strength, all of it at the centre
  double explosive = 20;     ///< kg of TNT
  double thermite_over = 6;  ///< s, until a joint is through
};

}  // namespace topple::viewer
