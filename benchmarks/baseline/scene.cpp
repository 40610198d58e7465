#include "scene.h"

#include <sstream>
#include <stdexcept>

namespace baseline {

namespace {

template <std::size_t N>
void read(std::istream& in, std::array<double, N>& values) {
  for (double& value : values) in >> value;
}

/// By its number, of those already there.
SceneBody& read_body(std::istream& in, Scene& scene) {
  std::size_t number = 0;
  if (!(in >> number) || number >= scene.bodies.size())
    throw std::runtime_error("a body that is not there, or not yet");
  return scene.bodies[number];
}

void read_line(std::istream& in, const std::string& kind, Scene& scene) {
  if (kind == "gravity") {
    in >> scene.gravity;
  } else if (kind == "ground") {
    in >> scene.ground;
    scene.has_ground = true;
  } else if (kind == "static_sag") {
    in >> scene.static_sag;
  } else if (kind == "body") {
    SceneBody& body = scene.bodies.emplace_back();
    in >> body.name >> body.mass;
    read(in, body.half_extents);
    read(in, body.centre);
    read(in, body.orientation);
  } else if (kind == "ball") {
    read_body(in, scene).ball = true;
  } else if (kind == "state") {
    SceneBody& body = read_body(in, scene);
    read(in, body.velocity);
    read(in, body.spin);
    in >> body.asleep;
  } else if (kind == "joint") {
    SceneJoint& joint = scene.joints.emplace_back();
    in >> joint.name >> joint.body >> joint.other;
    read(in, joint.point);
    in >> joint.has_force;
    if (joint.has_force) read(in, joint.force);
  } else if (kind == "roof") {
    RoofPoint& roof = scene.roof.emplace_back();
    in >> roof.body;
    read(in, roof.point);
  } else if (kind == "push") {
    ScenePush& push = scene.pushes.emplace_back();
    in >> push.body;
    read(in, push.point);
    read(in, push.force);
  } else {
    throw std::runtime_error("unknown word " + kind);
  }
  if (in.fail()) throw std::runtime_error("a number is missing after " + kind);
}

}  // namespace

Scene read_scene(std::istream& in) {
  Scene scene;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string kind;
    if (!(words >> kind)) continue;
    try {
      read_line(words, kind, scene);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("scene, line " + std::to_string(number) + ": " + error.what());
    }
  }
  const int count = static_cast<int>(scene.bodies.size());
  for (const SceneJoint& joint : scene.joints) {
    if (joint.body < 0 || joint.body >= count || joint.other < -1 || joint.other >= count) {
      throw std::runtime_error("scene: joint " + joint.name + " names a body that is not there");
    }
  }
  for (const ScenePush& push : scene.pushes) {
    if (push.body < 0 || push.body >= count) throw std::runtime_error("scene: a push names a body that is not there");
  }
  return scene;
}

}  // namespace baseline
