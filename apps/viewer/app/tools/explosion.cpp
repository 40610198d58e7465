#include "app/tools/explosion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace topple::viewer {
namespace {

using structure::Building;
using structure::HostContact;
using structure::Member;
using structure::Panel;
using structure::Vec3;

constexpr double spacing = 0.5;         // m, between places that are struck
constexpr double nearest = 0.2;         // m: a charge is no point
constexpr double stand_in_size = 0.05;  // m, from the place to the centre of the striking body

class Wave {
 public:
  Wave(const structure::Simulation& simulation, const Explosion& explosion)
      : simulation_(simulation), building_(simulation.building()), explosion_(explosion) {}

  void strike(structure::PanelId id) {
    const Panel& panel = building_[id];
    const auto corner = [&](std::size_t i) -> const Vec3& { return building_[panel.nodes[i]].position; };
    const Vec3 u = corner(1) - corner(0), v = corner(3) - corner(0);
    const int across = std::max(1, static_cast<int>(u.norm() / spacing)),
              up = std::max(1, static_cast<int>(v.norm() / spacing));
    const double area = u.cross(v).norm() / (across * up);
    const double mass = area * panel.thickness * building_[panel.material].density;
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) {
        const Vec3 place = corner(0) + (i + 0.5) / across * u + (j + 0.5) / up * v;
        const auto met = simulation_.ray_cast(explosion_.centre, place - explosion_.centre);
        if (!met || met->panel != id || (met->point - place).norm() > panel.thickness) continue;
        Vec3 normal = u.cross(v).normalized();
        if (normal.dot(place - explosion_.centre) < 0) normal = -normal;
        HostContact contact;
        contact.panel = id;
        add(contact, met->point, normal, area, mass);
      }
  }
  void strike(structure::MemberId id) {
    const Member& member = building_[id];
    const structure::Section& section = building_[member.section];
    const Vec3 from = building_[member.nodes[0]].position + member.offsets[0];
    const Vec3 axis = member.axes.row(0).transpose();
    const int parts = std::max(1, static_cast<int>(member.length / spacing));
    const double side = std::max({section.width, section.depth, std::sqrt(section.area)}), part = member.length / parts;
    const double mass = section.area * part * building_[member.material].density;
    for (int i = 0; i < parts; ++i) {
      const Vec3 place = from + (i + 0.5) * part * axis;
      const auto met = simulation_.ray_cast(explosion_.centre, place - explosion_.centre);
      if (!met || met->member != id || (met->point - place).norm() > side) continue;
      const Vec3 way = place - explosion_.centre;
      HostContact contact;
      contact.member = id;
      const Vec3 normal = (way - way.dot(axis) * axis).normalized();
      if (normal.allFinite()) add(contact, met->point, normal, side * part, mass);
    }
  }
  /// The nearest first.
  [[nodiscard]] std::vector<HostContact> contacts() {
    std::stable_sort(found_.begin(), found_.end(), [&](const HostContact& a, const HostContact& b) {
      return (a.point - explosion_.centre).norm() < (b.point - explosion_.centre).norm();
    });
    for (std::size_t i = 0; i < found_.size(); ++i) found_[i].key = static_cast<std::int64_t>(i);
    return std::move(found_);
  }

 private:
  void add(HostContact contact, const Vec3& point, const Vec3& normal, double area, double mass) {
    const Vec3 way = point - explosion_.centre;
    const double distance = std::max(way.norm(), nearest), cosine = std::max(0.0, way.normalized().dot(normal));
    const double speed = reflected_impulse(distance, explosion_.charge) * cosine * area / mass;
    if (!(speed >= least_blast_speed)) return;
    contact.point = point;
    contact.normal = normal;
    contact.centre = point - stand_in_size * normal;
    contact.mass = mass;
    contact.inertia = mass * spacing * spacing / 6 * structure::Mat3::Identity();  // of a plate of that size
    contact.velocity = 2 * speed * normal;
    found_.push_back(contact);
  }

  const structure::Simulation& simulation_;
  const Building& building_;
  Explosion explosion_;
  std::vector<HostContact> found_;
};

}  // namespace

double reflected_impulse(double distance, double charge) {
  const double root = std::cbrt(charge), scaled = std::clamp(distance / root, 0.0531, 40.0);
  const double u = -0.204004553231 + 1.37882996018 * std::log10(scaled);
  const double y = 2.55875660396 + u * (-0.903118886091 + u * (0.101771877942 - 0.0242139751146 * u));
  return root * std::pow(10.0, y);  // kPa ms are Pa s
}

std::vector<HostContact> blast_contacts(const structure::Simulation& simulation, const Explosion& explosion) {
  Wave wave(simulation, explosion);
  const Building& building = simulation.building();
  for (std::size_t i = 0; i < building.panels.size(); ++i)
    if (const structure::PanelId id(i); simulation.frame().stands(id)) wave.strike(id);
  for (std::size_t i = 0; i < building.members.size(); ++i)
    if (const structure::MemberId id(i); simulation.frame().stands(id)) wave.strike(id);
  return wave.contacts();
}

}  // namespace topple::viewer
