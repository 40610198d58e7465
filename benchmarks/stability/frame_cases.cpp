#include <cmath>
#include <random>

#include "cases.h"
#include "support/regular_frame.h"

namespace topple::bench {

namespace {

using solver::Beam;
using solver::FrameModel;
using solver::LoadSet;
using solver::rigid;
using solver::Vec3;
using solver::Vec6;

/// A square bar of steel between two nodes, its y axis as level as it can be.
Beam bar(const FrameModel& model, int first, int second, double side) {
  Beam beam;
  beam.node = {first, second};
  const Vec3 along = model.nodes[static_cast<std::size_t>(second)] - model.nodes[static_cast<std::size_t>(first)];
  beam.length = along.norm();
  const Vec3 x = along / beam.length;
  const Vec3 up = std::abs(x.z()) > 0.999 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ());
  const Vec3 y = up.cross(x).normalized();
  beam.axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  beam.youngs_modulus = 210e9;
  beam.shear_modulus = 210e9 / 2.6;
  beam.area = side * side;
  beam.Iy = beam.Iz = side * side * side * side / 12;
  beam.J = 0.1406 * side * side * side * side;
  return beam;
}

void fix(FrameModel& model, int node) { model.supports.push_back({node, Vec6::Constant(rigid)}); }

void push(LoadSet& loads, int node, const Vec6& force) { loads.nodes.push_back({node, force}); }

/// Pinned about both bending axes.
void pin(Beam& beam, int end) { beam.end_stiffness[static_cast<std::size_t>(end)].tail<2>().setZero(); }

/// Of a node between pinned bars: it stays in the plane and does not turn.
Vec6 in_plane() {
  Vec6 hold = Vec6::Constant(rigid);
  hold[0] = hold[2] = 0;
  return hold;
}

const Vec6 oblique = (Vec6() << 1000, 700, -2000, 10, -20, 30).finished();

Case named(const char* family, const char* what, double parameter) {
  Case c;
  c.family = family;
  c.what = what;
  c.parameter = parameter;
  return c;
}

/// In a direction in which no number of the axes is exact.
const Vec3 skew = Vec3(0.48, 0.6, 0.64).normalized();

void stretch(Beam& beam, double factor) {
  beam.youngs_modulus *= factor;
  beam.shear_modulus *= factor;
}

Case chain(const char* what, int members) {
  Case c = named("chain length", what, static_cast<double>(members));
  for (int n = 0; n <= members; ++n) c.model.nodes.push_back(skew * n);
  for (int n = 0; n < members; ++n) c.model.beams.push_back(bar(c.model, n, n + 1, 0.2));
  fix(c.model, 0);
  return c;
}

Case ladder(int members) {
  Case c = named("chain length", "ladder held at one end", static_cast<double>(members));
  const int rungs = members / 3;
  for (int n = 0; n <= rungs; ++n) {
    c.model.nodes.push_back(skew * n);
    c.model.nodes.push_back(skew * n + Vec3(0, 0, 1));
  }
  for (int n = 0; n < rungs; ++n) {
    c.model.beams.push_back(bar(c.model, 2 * n, 2 * n + 2, 0.2));
    c.model.beams.push_back(bar(c.model, 2 * n + 1, 2 * n + 3, 0.2));
    c.model.beams.push_back(bar(c.model, 2 * n + 2, 2 * n + 3, 0.2));
  }
  fix(c.model, 0);
  fix(c.model, 1);
  push(c.loads, 2 * rungs, oblique);
  return c;
}

/// Two bars, nearly in line, pinned at both ends: only their rise bears the load.
Case toggle(double rise) {
  Case c = named("near-mechanism", "toggle of two bars, rise over span", rise);
  c.model.nodes = {Vec3(-1, 0, 0), Vec3(0, 0, rise), Vec3(1, 0, 0)};
  for (int n = 0; n < 2; ++n) {
    c.model.beams.push_back(bar(c.model, n, n + 1, 0.1));
    pin(c.model.beams.back(), 0);
    pin(c.model.beams.back(), 1);
  }
  fix(c.model, 0);
  fix(c.model, 2);
  Vec6 hold = in_plane();
  c.model.supports.push_back({1, hold});
  push(c.loads, 1, (Vec6() << 10, 0, -20, 0, 0, 0).finished());
  c.mechanism = rise == 0;
  return c;
}

/// Four bars pinned at all ends, kept upright by a spring alone.
Case propped_sway(double spring) {
  Case c = named("near-mechanism", "pinned portal on a spring, N/m", spring);
  c.model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 3), Vec3(4, 0, 3), Vec3(4, 0, 0)};
  for (int n = 0; n < 3; ++n) {
    c.model.beams.push_back(bar(c.model, n, n + 1, 0.2));
    pin(c.model.beams.back(), 0);
    pin(c.model.beams.back(), 1);
  }
  fix(c.model, 0);
  fix(c.model, 3);
  Vec6 hold = in_plane();
  c.model.supports.push_back({2, hold});
  hold[0] = spring;
  c.model.supports.push_back({1, hold});
  push(c.loads, 1, (Vec6() << 1e-3, 0, -2000, 0, 0, 0).finished());
  c.mechanism = spring == 0;
  return c;
}

/// A cantilever on a rotational spring at its root.
Case loose_root(double spring) {
  Case c = named("near-mechanism", "cantilever on a root spring, N m/rad", spring);
  c.model.nodes = {Vec3::Zero(), skew * 2};
  c.model.beams.push_back(bar(c.model, 0, 1, 0.2));
  c.model.beams[0].end_stiffness[0][4] = spring;
  fix(c.model, 0);
  push(c.loads, 1, oblique * 1e-3);
  c.mechanism = spring == 0;
  return c;
}

/// A storey of pinned posts that one brace holds, of less and less area.
Case thin_brace(double share) {
  Case c = named("near-mechanism", "pinned storey with a thin brace, area over a post's", share);
  c.model.nodes = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 0, 3), Vec3(4, 0, 3)};
  for (const auto& [a, b] : {std::pair{0, 2}, std::pair{1, 3}, std::pair{2, 3}}) {
    c.model.beams.push_back(bar(c.model, a, b, 0.2));
    pin(c.model.beams.back(), 0);
    pin(c.model.beams.back(), 1);
  }
  if (share > 0) {
    c.model.beams.push_back(bar(c.model, 0, 3, 0.2 * std::sqrt(share)));
    pin(c.model.beams.back(), 0);
    pin(c.model.beams.back(), 1);
  }
  fix(c.model, 0);
  fix(c.model, 1);
  Vec6 hold = in_plane();
  c.model.supports.push_back({2, hold});
  c.model.supports.push_back({3, hold});
  push(c.loads, 3, (Vec6() << 1, 0, -20, 0, 0, 0).finished());
  c.mechanism = share == 0;
  return c;
}

/// Numbers between 0 and 1, and by decades, the same on every machine.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double share() { return static_cast<double>(random_()) / 4294967296.0; }
  double power(double least, double most) { return std::pow(10.0, least + (most - least) * share()); }
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  Vec3 place(double size) { return size * Vec3(share(), share(), share()); }

 private:
  std::mt19937 random_;
};

Case from_regular(const char* family, const char* what, double parameter, const RegularFrame& frame) {
  return {.family = family, .what = what, .parameter = parameter, .model = frame.model, .loads = frame.loads};
}

}  // namespace

std::vector<Case> stiffness_ratios() {
  std::vector<Case> cases;
  const RegularFrame frame = regular_frame(3, 3, 4);
  const std::size_t posts = 9, storey = posts + 12;  // members in order of storeys, posts first
  for (int power = 0; power <= 14; power += 2) {
    const double ratio = std::pow(10.0, power);
    Case stiff = from_regular("stiffness ratio", "posts of the third storey stiffer", ratio, frame);
    Case soft = from_regular("stiffness ratio", "posts of the third storey softer", ratio, frame);
    for (std::size_t p = 0; p < posts; ++p) {
      stretch(stiff.model.beams[2 * storey + p], ratio);
      stretch(soft.model.beams[2 * storey + p], 1 / ratio);
    }
    Case one = from_regular("stiffness ratio", "one beam stiffer", ratio, frame);
    stretch(one.model.beams[storey + posts + 3], ratio);
    Case mixed = from_regular("stiffness ratio", "every member by chance", ratio, frame);
    std::mt19937 random(7);
    for (Beam& beam : mixed.model.beams) stretch(beam, std::pow(ratio, static_cast<double>(random()) / 4294967296.0));
    for (Case* c : {&stiff, &soft, &one, &mixed}) {
      push(c->loads, static_cast<int>(c->model.nodes.size()) - 1, oblique);
      cases.push_back(std::move(*c));
    }
  }
  return cases;
}

std::vector<Case> slendernesses() {
  std::vector<Case> cases;
  for (const double slenderness : {2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    Case c = named("slenderness", "portal of square bars", slenderness);
    c.model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 3), Vec3(3, 0.1, 3), Vec3(3, 0.1, 0)};
    for (int n = 0; n < 3; ++n) c.model.beams.push_back(bar(c.model, n, n + 1, 3 / slenderness));
    fix(c.model, 0);
    fix(c.model, 3);
    push(c.loads, 1, oblique * std::pow(slenderness, -4));
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<Case> chains(int most) {
  std::vector<Case> cases;
  for (int members = 10; members <= most; members *= 10) {
    Case cantilever = chain("cantilever", members);
    push(cantilever.loads, members, oblique);
    cases.push_back(std::move(cantilever));
    Case held = chain("held at every tenth node", members);
    Vec6 hold = Vec6::Zero();
    hold.head<3>().setConstant(rigid);
    for (int n = 10; n <= members; n += 10) held.model.supports.push_back({n, hold});
    for (int n = 5; n <= members; n += 10) push(held.loads, n, oblique * (1 + n % 7));
    cases.push_back(std::move(held));
    if (members >= 100) cases.push_back(ladder(members));
  }
  return cases;
}

std::vector<Case> unit_systems() {
  std::vector<Case> cases;
  struct Units {
    const char* name;
    double length, force;  ///< how many make a metre, a newton
  };
  for (const Units& u :
       {Units{"m, N", 1, 1}, Units{"mm, N", 1e3, 1}, Units{"mm, kN", 1e3, 1e-3}, Units{"m, MN", 1, 1e-6},
        Units{"in, lbf", 1 / 0.0254, 1 / 4.4482216152605}, Units{"ft, kip", 1 / 0.3048, 1 / 4448.2216152605},
        Units{"km, N", 1e-3, 1}, Units{"nm, uN", 1e9, 1e6}, Units{"Mm, GN", 1e-6, 1e-9}}) {
    RegularFrame frame = regular_frame(3, 3, 4);
    const double a = u.length, f = u.force;
    for (Vec3& node : frame.model.nodes) node *= a;
    for (Beam& beam : frame.model.beams) {
      beam.length *= a;
      beam.youngs_modulus *= f / (a * a);
      beam.shear_modulus *= f / (a * a);
      beam.area *= a * a;
      for (double* inertia : {&beam.Iy, &beam.Iz, &beam.J}) *inertia *= a * a * a * a;
    }
    for (solver::BeamLoad& load : frame.loads.beams) {
      load.to *= a;
      load.first *= f / a;
      load.last *= f / a;
    }
    Case c = from_regular("unit system", u.name, 1e3 * a, frame);
    Vec6 force = oblique * f;
    force.tail<3>() *= a;
    push(c.loads, static_cast<int>(c.model.nodes.size()) - 1, force);
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<Case> near_mechanisms() {
  std::vector<Case> cases;
  for (int power = 1; power <= 9; ++power) cases.push_back(toggle(std::pow(10.0, -power)));
  cases.push_back(toggle(0));
  for (int power = 8; power >= -10; power -= 2) cases.push_back(propped_sway(std::pow(10.0, power)));
  cases.push_back(propped_sway(0));
  for (int power = 9; power >= -9; power -= 2) cases.push_back(loose_root(std::pow(10.0, power)));
  cases.push_back(loose_root(0));
  for (int power = 0; power >= -16; power -= 2) cases.push_back(thin_brace(std::pow(10.0, power)));
  cases.push_back(thin_brace(0));
  return cases;
}

// A tree of members from a fixed node, with some more between any two nodes.
Case chance_frame(unsigned seed) {
  Chance chance(seed);
  Case c = named("by chance", "small frame", seed);
  const double size = chance.power(-1, 2), thickness = chance.power(-3, -1), spread = 2 * chance.share();
  const int nodes = 2 + chance.below(6), extra = chance.below(4);
  c.model.nodes.push_back(chance.place(size));
  const auto add = [&](int a, int b) {
    Beam beam = bar(c.model, a, b, size * thickness * chance.power(-spread, 0));
    beam.Iz *= chance.power(-1, 0);
    if (chance.below(4) == 0) beam.shear_area_y = beam.shear_area_z = beam.area / 2;
    if (chance.below(4) == 0)
      beam.end_stiffness[1][4] = chance.power(-2, 4) * beam.youngs_modulus * beam.Iy / beam.length;
    c.model.beams.push_back(beam);
  };
  for (int n = 1; n < nodes; ++n) {
    c.model.nodes.push_back(chance.place(size) + Vec3(0, 0, 0.1 * size * n));
    add(chance.below(n), n);
  }
  for (int i = 0; i < extra; ++i) {
    const int a = chance.below(nodes), b = chance.below(nodes);
    if (a != b) add(a, b);
  }
  fix(c.model, 0);
  Vec6 force;
  for (double& component : force) component = chance.share() - 0.5;
  push(c.loads, nodes - 1, force * 1e3);
  return c;
}

}  // namespace topple::bench
