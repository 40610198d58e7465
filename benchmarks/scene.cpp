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
#include "topple/structure/files.h"
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
    for (const std::size_t i : members_in_order(building_)) member_joints(i);
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
      if (member.kind == MemberKind::post) post_below_[member.nodes[1].index] = member.name;
    }
    if (frame_only_) return;
    for (std::size_t i = 0; i < building_.panels.size(); ++i) {
      double area = 0;
      Body body = panel_body(building_, building_.panels[i], area);
      const PanelAction& action = loads_.panels[i];
      const double down = -action.body_force.z() + action.pressure * building_.panels[i].axes(2, 2);
      body.mass = down * area / building_.gravity;
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

  /// A post is joined to the post below (or the ground) at its lower end; a beam at both ends to the lower posts.
  void member_joints(std::size_t i) {
    const Member& member = building_.members[i];
    for (int end = 0; end < (member.kind == MemberKind::post ? 1 : 2); ++end) {
      const NodeId node = member.nodes[static_cast<std::size_t>(end)];
      const auto below = post_below_.find(node.index);
      const int other = below == post_below_.end() ? -1 : body_of_.at(below->second);
      const auto& local = solution_.beam_end_forces[i];
      Eigen::Matrix<double, 6, 1> force;
      force.head<3>() = member.axes.transpose() * local.segment<3>(6 * end);
      force.tail<3>() = member.axes.transpose() * local.segment<3>(6 * end + 3);
      joint(member.name + ':' + std::to_string(end + 1), body_of_.at(member.name), other, position(building_, node),
            &force);
    }
  }

  /// At the middle of each edge, to the member there: a slab has four beams, a wall two beams and two posts.
  void panel_joints() {
    const EdgeMembers edges(building_);
    for (std::size_t i = 0; i < building_.panels.size(); ++i) {
      const Panel& panel = building_.panels[i];
      for (int edge = 0; edge < 4; ++edge) {
        const std::vector<MemberId>& along = edges.of(PanelId(i), edge);
        if (along.empty()) continue;
        const Vec3 middle = (position(building_, panel.nodes[static_cast<std::size_t>(edge)]) +
                             position(building_, panel.nodes[static_cast<std::size_t>((edge + 1) % 4)])) /
                            2;
        joint(panel.name + ':' + std::to_string(edge + 1), body_of_.at(panel.name),
              body_of_.at(building_[along.front()].name), middle, nullptr);
      }
    }
  }

  void roof() {
    double sag = 0;
    int points = 0;
    for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
      if (!on_roof(n)) continue;
      std::cout << "roof " << body_of_.at(post_below_.at(static_cast<int>(n))) << ' '
                << building_.nodes[n].position.transpose() << '\n';
      sag -= solution_.displacements[n].z();
      ++points;
    }
    std::cout << "static_sag " << sag / points << '\n';
    if (push_ == 0) return;
    std::cout << "push " << body_of_.at(post_below_.at(pushed_)) << ' '
              << building_.nodes[static_cast<std::size_t>(pushed_)].position.transpose() << " 0 0 " << -push_ << '\n';
  }

  const Building& building_;
  PartLoads loads_;
  bool frame_only_ = false;
  double push_ = 0, height_ = -1e300;
  int pushed_ = -1;
  solver::StaticSolution solution_;
  std::map<std::string, int> body_of_;
  std::map<int, std::string> post_below_;
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
