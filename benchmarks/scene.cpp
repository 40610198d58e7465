// Writes a building as rigid bodies and joints in plain numbers, with what frame analysis says of each joint: the scene
// that the Bullet baseline simulates (baseline/scene.h has the format).
//   bench_scene MODEL [--combination NAME] [--frame-only] [--push NEWTON]
// --push: downwards on the first node of the roof; forces and sag count it once, whatever it does in time.
// Mass is weight over gravity. Posts come first, then beams, then slabs and walls; so do their joints.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <stdexcept>

#include "support/rigid_bodies.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/building.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"

namespace {

using namespace topple;
using namespace topple::structure;
using namespace topple::bench;

class Writer {
 public:
  Writer(const Building& building, CombinationId combination, bool frame_only, double push)
      : building_(building), loads_(part_loads(building, combination)), push_(push) {
    frame_only_ = frame_only;
    if (frame_only) {
      for (PanelAction& action : loads_.panels) action = {};
    }
    solver::StaticAnalysis analysis(make_frame(building).model);
    std::vector<solver::LoadSet> sets{load_set(building, loads_)};
    for (const Node& node : building.nodes) height_ = std::max(height_, node.position.z());
    for (std::size_t n = 0; pushed_ < 0 && n < building.nodes.size(); ++n)
      if (on_roof(n)) pushed_ = static_cast<int>(n);
    sets[0].nodes.push_back({pushed_, solver::Vec6::Unit(2) * -push});
    solution_ = analysis.solve(sets).front();
  }

  void run() {
    std::cout << std::setprecision(17) << "gravity " << building_.gravity << '\n';
    bodies();
    member_joints();
    if (!frame_only_) panel_joints();
    roof();
  }

 private:
  [[nodiscard]] bool on_roof(std::size_t node) const { return building_.nodes[node].position.z() > height_ - 1e-6; }

  void bodies() {
    for (const std::size_t i : members_in_order(building_)) {
      const Member& member = building_.members[i];
      body_of_[member.name] = count_++;
      write(member_body(building_, member, total(loads_.members[i], member.axes)), std::cout);
    }
    if (frame_only_) return;
    for (std::size_t i = 0; i < building_.panels.size(); ++i) {
      const Body body = panel_body(building_, building_.panels[i], loads_.panels[i]);
      if (!(body.mass > 0)) throw std::runtime_error("panel " + body.name + " has no weight");
      body_of_[body.name] = count_++;
      write(body, std::cout);
    }
  }

  void joint(const std::string& name, int body, int other, const Vec3& point,
             const Eigen::Matrix<double, 6, 1>* force) {
    std::cout << "joint " << name << ' ' << body << ' ' << other << ' ' << point.transpose() << ' ' << (force ? 1 : 0);
    if (force) std::cout << ' ' << force->transpose();
    std::cout << '\n';
  }

  void member_joints() {
    visit_member_joints(building_, [&](MemberId id, int end, MemberId below, const Vec3& point) {
      const Member& member = building_[id];
      const auto& local = solution_.beam_end_forces[static_cast<std::size_t>(id.index)];
      Eigen::Matrix<double, 6, 1> force;
      force.head<3>() = member.axes.transpose() * local.segment<3>(6 * end);
      force.tail<3>() = member.axes.transpose() * local.segment<3>(6 * end + 3);
      joint(joint_name(member.name, end), body_of_.at(member.name),
            below.valid() ? body_of_.at(building_[below].name) : -1, point, &force);
    });
  }

  void panel_joints() {
    visit_panel_joints(building_, [&](PanelId id, int edge, MemberId along, const Vec3& middle) {
      const std::string& name = building_[id].name;
      joint(joint_name(name, edge), body_of_.at(name), body_of_.at(building_[along].name), middle, nullptr);
    });
  }

  void roof() {
    const std::map<int, MemberId> posts = posts_below(building_);
    const auto post = [&](int node) { return body_of_.at(building_[posts.at(node)].name); };
    double sag = 0;
    int points = 0;
    for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
      if (!on_roof(n)) continue;
      std::cout << "roof " << post(static_cast<int>(n)) << ' ' << building_.nodes[n].position.transpose() << '\n';
      sag -= solution_.displacements[n].z();
      ++points;
    }
    std::cout << "static_sag " << sag / points << '\n';
    if (push_ == 0) return;
    std::cout << "push " << post(pushed_) << ' '
              << building_.nodes[static_cast<std::size_t>(pushed_)].position.transpose() << " 0 0 " << -push_ << '\n';
  }

  const Building& building_;
  PartLoads loads_;
  bool frame_only_ = false;
  double push_ = 0, height_ = -1e300;
  int pushed_ = -1;
  solver::StaticSolution solution_;
  std::map<std::string, int> body_of_;
  int count_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2)
      throw std::runtime_error("usage: bench_scene MODEL [--combination NAME] [--frame-only] [--push NEWTON]");
    std::string wanted;
    bool frame_only = false;
    double push = 0;
    for (int i = 2; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--frame-only") {
        frame_only = true;
      } else if (option == "--combination" && i + 1 < argc) {
        wanted = argv[++i];
      } else if (option == "--push" && i + 1 < argc) {
        push = std::stod(argv[++i]);
      } else {
        throw std::runtime_error("unknown option " + option);
      }
    }
    const Building building = read_model(find_model(argv[1]));
    for (std::size_t c = 0; c < building.combinations.size(); ++c) {
      if (!wanted.empty() && building.combinations[c].name != wanted) continue;
      Writer(building, CombinationId(c), frame_only, push).run();
      return 0;
    }
    throw std::runtime_error("no combination " + wanted);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
