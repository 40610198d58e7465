#include "renderer/shapes/dust.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace topple::viewer {
namespace {

using structure::SimulationEvent;

/// Radius of the cloud of a broken joint, of a broken panel, m.
constexpr double joint_size = 0.5, panel_size = 1.6;
/// Of an impact: by the cube root of its energy, J, as the cloud's volume goes with the energy; at most this.
constexpr double size_per_root_joule = 0.05, largest_size = 5.0;
/// A body that loses more than this speed within a step has landed, m/s; smaller ones than this size throw up nothing.
constexpr double landing_speed = 1.5;
/// Puffs of one landing: along its lowest parts, at most this many.
constexpr std::size_t landing_puffs = 16;
constexpr std::size_t most_puffs = 700;
/// Closer ones of one instant are one, m.
constexpr double merging_distance = 1.0;
/// A smaller one where a larger rose so shortly before adds nothing to be seen, s.
constexpr double settled_after = 0.5;

/// Discs for each puff.
constexpr int discs = 5;
constexpr float densest = 0.8F, dense_size = 1.2F;

/// Radius of an explosion's ball by the cube root of its charge, m; how long it glows, s; its discs.
constexpr double ball_per_root_kilogram = 0.9;
constexpr float ball_life = 0.45F;
constexpr int ball_discs = 16;

/// A place that burns throws up a lick of flame this often, s, of this size, m; where much burns, all of it together no
/// more often than `least_interval`.
constexpr double lick_interval = 0.12, least_interval = 0.012, lick_size = 0.8;
constexpr float flame_life = 0.8F;
/// Hot gas rises at this speed, smoke as it cools, m/s.
constexpr float flame_speed = 2.2F, smoke_speed = 1.3F;

/// Sparks of one puff at its largest; their fastest, m/s; how long the last glows, s.
constexpr int most_sparks = 40;
constexpr float spark_speed = 9, spark_life = 0.9F, gravity = 9.81F;

/// Of the dust that this turns to.
Rgba dust_colour(Look look) {
  switch (look) {
    case Look::brick:
      return rgba(186, 168, 154);
    case Look::plaster:
      return rgba(214, 209, 199);
    case Look::timber:
      return rgba(186, 164, 132);
    default:
      return rgba(196, 190, 178);
  }
}

DustPuff puff_of(double time, const Eigen::Vector3d& position, double size, Look heard, double mass, bool broke) {
  DustPuff puff;
  puff.time = time;
  puff.position = position;
  puff.size = static_cast<float>(size);
  puff.material = static_cast<std::uint8_t>(heard);
  puff.mass = static_cast<float>(mass);
  puff.broke = broke;
  return puff;
}

double energy_size(double energy) { return std::min(largest_size, size_per_root_joule * std::cbrt(energy)); }

/// A number from 0 to 1 that is always the same for the same words (Steele, Lea, Flood 2014: splitmix64's mixer).
float noise(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15u;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
  return static_cast<float>((word ^ (word >> 31)) >> 40) / static_cast<float>(1u << 24);
}

/// Where the lowest parts of a body are.
std::vector<Eigen::Vector3d> lowest_parts(const structure::Building& building, const structure::BodyView& body) {
  std::vector<Eigen::Vector3d> places;
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return body.pose.position + body.pose.orientation * (p - body.rest_centre);
  };
  for (const structure::MemberId id : body.members)
    for (const structure::NodeId node : building[id].nodes) places.push_back(moved(building[node].position));
  for (const structure::PanelId id : body.panels)
    for (const structure::NodeId node : building[id].nodes) places.push_back(moved(building[node].position));
  if (places.empty()) return {body.pose.position};
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  const double limit = places.front().z() + 0.5;
  places.erase(std::find_if(places.begin(), places.end(), [&](const auto& p) { return p.z() > limit; }), places.end());
  if (places.size() <= landing_puffs) return places;
  std::vector<Eigen::Vector3d> some;
  for (std::size_t i = 0; i < landing_puffs; ++i) some.push_back(places[i * places.size() / landing_puffs]);
  return some;
}

}  // namespace

double energy_of(const DustPuff& puff) { return std::pow(static_cast<double>(puff.size) / size_per_root_joule, 3); }

/// Of an impact or break at this place; what it was of steel strikes sparks instead.
void DustWatcher::throw_up(DustPuff puff, Look look) {
  puff.kind = look == Look::steel ? DustPuff::Kind::sparks : DustPuff::Kind::dust;
  for (auto old = puffs_.rbegin(); old != puffs_.rend() && old->time + settled_after > puff.time; ++old)
    if (old->kind == puff.kind && (old->position - puff.position).squaredNorm() < merging_distance * merging_distance) {
      if (old->time < puff.time && old->size >= puff.size) return;
      if (old->time < puff.time) continue;
      const double volume = std::pow(static_cast<double>(old->size), 3) + std::pow(static_cast<double>(puff.size), 3);
      old->size = static_cast<float>(std::min(largest_size, std::cbrt(volume)));
      old->mass = std::max(old->mass, puff.mass);
      return;
    }
  puff.number = thrown_up_++;
  puff.colour = dust_colour(look);
  puffs_.push_back(puff);
  changed_ = true;
}

void DustWatcher::blast(const Eigen::Vector3d& centre, double charge) {
  blasts_.push_back(
      {0, 0, centre, static_cast<float>(ball_per_root_kilogram * std::cbrt(charge)), DustPuff::Kind::blast});
}

DustWatcher::Stuff DustWatcher::stuff_of(const structure::Building& building, const std::string& name) {
  if (!names_) names_ = std::make_unique<structure::NameIndex>(building);
  // Chunks are named after what they broke out of: "W#3".
  const std::string whole = name.substr(0, name.rfind('#'));
  auto member = names_->member(whole);
  auto panel = names_->panel(whole);
  if (const auto joint = names_->joint(whole)) {
    if (building[*joint].member.valid()) member = building[*joint].member;
    if (building[*joint].panel.valid()) panel = building[*joint].panel;
  }
  if (member) {
    const structure::Material& material = building[building[*member].material];
    return {look_of(material), material.density * building[building[*member].section].area * building[*member].length};
  }
  if (!panel) return {};
  const structure::Panel& one = building[*panel];
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& { return building[one.nodes[i]].position; };
  const double area = (corner(2) - corner(0)).cross(corner(3) - corner(1)).norm() / 2;
  const structure::Material& material = building[one.material];
  return {look_of(material), material.density * one.thickness * area};
}

void DustWatcher::hear_impact(const structure::Building& building, const SimulationEvent& event) {
  const double energy = event.mass * (event.speed_in * event.speed_in - event.speed_out * event.speed_out) / 2;
  if (!(event.speed_in > landing_speed && energy > 0)) return;
  const Stuff struck = stuff_of(building, event.name);
  throw_up(puff_of(event.time, event.position, energy_size(energy), struck.look, event.mass, false), struck.look);
}

void DustWatcher::hear(const structure::Simulation& simulation) {
  const auto& events = simulation.events();
  const structure::Building& building = simulation.building();
  for (; events_heard_ < events.size(); ++events_heard_) {
    const SimulationEvent& event = events[events_heard_];
    const bool joint = event.kind == SimulationEvent::Kind::joint_broke;
    if (joint || event.kind == SimulationEvent::Kind::panel_fractured) {
      const Stuff stuff = stuff_of(building, event.name);
      throw_up(puff_of(event.time, event.position, joint ? joint_size : panel_size, stuff.look, stuff.mass, true),
               stuff.look);
    }
    if (event.kind == SimulationEvent::Kind::impact) hear_impact(building, event);
  }
}

void DustWatcher::find_landings(const structure::Simulation& simulation) {
  const double passed = simulation.time() - time_;
  std::map<std::int64_t, Seen> now;
  for (const structure::BodyView& body : simulation.bodies()) {
    if (body.asleep) continue;
    Seen seen{body.pose.position, Eigen::Vector3d::Zero()};
    if (const auto before = bodies_.find(body.id.value); before != bodies_.end() && passed > 0) {
      seen.velocity = (seen.position - before->second.position) / passed;
      const double slowed = before->second.velocity.norm() - seen.velocity.norm();
      if (slowed > landing_speed) {
        const auto places = lowest_parts(simulation.building(), body);
        const double size = energy_size(body.mass * slowed * slowed / 2 / static_cast<double>(places.size()));
        // What steel throws up where it lands is the ground's.
        const Look heard = stuff_of(simulation.building(), std::string(body.name)).look;
        // What steel throws up where it lands is the ground's.
        for (const Eigen::Vector3d& place : places)
          throw_up(puff_of(simulation.time(), place, size, heard, body.mass, false), Look::concrete);
      }
    }
    now.emplace(body.id.value, seen);
  }
  bodies_ = std::move(now);
  time_ = simulation.time();
}

namespace {

/// Where a point of the undeformed building is that moves with this member; none: the member is gone.
std::optional<Eigen::Vector3d> position_with(const structure::Simulation& simulation, structure::MemberId member,
                                             const Eigen::Vector3d& at) {
  const auto body = simulation.body_of(member);
  if (body.value == part_stands) return at;
  const auto bodies = simulation.bodies();
  const auto found = std::lower_bound(bodies.begin(), bodies.end(), body.value,
                                      [](const auto& one, std::int64_t id) { return one.id.value < id; });
  if (found == bodies.end() || found->id.value != body.value) return std::nullopt;
  return found->pose.position + found->pose.orientation * (at - found->rest_centre);
}

}  // namespace

void DustWatcher::fire_at(const Eigen::Vector3d& place, double time, double size, DustPuff::Kind kind) {
  puffs_.push_back({thrown_up_++, time, place, static_cast<float>(size), kind});
  changed_ = true;
}

bool DustWatcher::burns(double time) const {
  return std::any_of(fires_.begin(), fires_.end(),
                     [time](const LaidFire& fire) { return fire.from <= time && time < fire.until; });
}

/// The places that burn take turns, by the time alone, so that a run made again burns as it did.
void DustWatcher::burn_on(const structure::Simulation& simulation) {
  const structure::Building& building = simulation.building();
  const double now = simulation.time(), before = std::max(time_, now - 0.1);
  for (const LaidFire& fire : fires_) {
    const std::size_t places = fire.members.size() + fire.joints.size();
    if (places == 0 || now < fire.from || before >= fire.until) continue;
    // Each of many burns for its neighbours too, up to flames as high as a storey.
    const double size =
        lick_size * std::clamp(std::sqrt(static_cast<double>(places) * least_interval / lick_interval), 1.0, 4.0);
    const double interval = std::max(lick_interval / static_cast<double>(places), least_interval);
    const auto number = [&](double time) {
      return static_cast<std::int64_t>(std::floor((std::min(time, fire.until) - fire.from) / interval));
    };
    for (std::int64_t lick = std::max<std::int64_t>(number(before) + 1, 0); lick <= number(now); ++lick) {
      // A step through the places that meets all of them before one comes again.
      const std::size_t i = static_cast<std::size_t>(lick) * 7919 % places;
      const bool of_joint = i >= fire.members.size();
      const structure::JointId joint = of_joint ? fire.joints[i - fire.members.size()] : structure::JointId();
      const structure::MemberId member = of_joint ? building[joint].member : fire.members[i];
      if (!member.valid()) continue;
      const auto end = [&](std::size_t e) -> const Eigen::Vector3d& {
        return building[building[member].nodes[e]].position;
      };
      const Eigen::Vector3d at =
          of_joint ? end(static_cast<std::size_t>(building[joint].end)) : Eigen::Vector3d((end(0) + end(1)) / 2);
      if (const auto place = position_with(simulation, member, at)) fire_at(*place, now, size, fire.kind);
    }
  }
}

std::shared_ptr<const std::vector<DustPuff>> DustWatcher::watch(const structure::Simulation& simulation) {
  changed_ = false;
  hear(simulation);
  for (DustPuff& blast : blasts_) {
    blast.number = thrown_up_++;
    blast.time = simulation.time();
    puffs_.push_back(blast);
    changed_ = true;
  }
  blasts_.clear();
  burn_on(simulation);
  find_landings(simulation);
  const std::size_t before = puffs_.size();
  std::erase_if(puffs_, [&](const DustPuff& puff) { return puff.time + dust_life < simulation.time(); });
  if (puffs_.size() > most_puffs) puffs_.erase(puffs_.begin(), puffs_.end() - static_cast<std::ptrdiff_t>(most_puffs));
  changed_ = changed_ || puffs_.size() != before;
  if (changed_) shared_ = puffs_.empty() ? nullptr : std::make_shared<const std::vector<DustPuff>>(puffs_);
  return shared_;
}

namespace {

/// Thrown out fast, held up by the air, thinned out as it spreads, carried by the wind.
void append_cloud(const DustPuff& puff, float age, const glm::vec3& at, std::vector<DustInstance>& instances) {
  const float spread = 1 - std::exp(-2.2F * age), left = 1 - age / static_cast<float>(dust_life);
  // What little there is of a small puff is thin.
  const float opacity =
      densest * left * left * left * std::min(1.0F, age / 0.08F) * std::min(1.0F, puff.size / dense_size);
  // The wind takes hold as the throw ends.
  const float drift = age - spread / 2.2F;
  const glm::vec3 carried(wind[0] * drift, wind[1] * drift, 0.15F * puff.size * drift);
  for (int i = 0; i < discs; ++i) {
    const std::uint64_t word = static_cast<std::uint64_t>(puff.number * 4 * discs + 4 * i);
    const float angle = 6.2831853F * (static_cast<float>(i) + noise(word)) / discs;
    const float out = puff.size * (0.25F + 0.75F * noise(word + 1)) * spread;
    const glm::vec3 way(std::cos(angle) * out, std::sin(angle) * out, puff.size * 0.6F * noise(word + 2) * spread);
    instances.push_back({at + way + carried, puff.size * (0.3F + (0.6F + 0.4F * noise(word + 3)) * spread), opacity,
                         puff.colour & 0xffffffU, noise(word + 1)});
  }
}

/// Each flies by itself and cools.
void append_sparks(const DustPuff& puff, float age, const glm::vec3& at, std::vector<DustInstance>& instances) {
  const int count = std::clamp(static_cast<int>(static_cast<float>(most_sparks) * puff.size), 6, most_sparks);
  for (int i = 0; i < count; ++i) {
    const std::uint64_t word = static_cast<std::uint64_t>(puff.number * 4 * most_sparks + 4 * i);
    const float life = spark_life * (0.3F + 0.7F * noise(word));
    if (age >= life) continue;
    const float angle = 6.2831853F * noise(word + 1), speed = spark_speed * (0.2F + 0.8F * noise(word + 2));
    const float rise = 1.6F * noise(word + 3) - 0.4F, level = std::sqrt(std::max(0.0F, 1 - rise * rise));
    const glm::vec3 way = speed * glm::vec3(level * std::cos(angle), level * std::sin(angle), rise);
    const float cold = age / life;
    instances.push_back({at + age * way - glm::vec3(0, 0, gravity / 2 * age * age), 0.07F * (1 - 0.6F * cold), 1,
                         rgba(255, static_cast<unsigned>(230 - 130 * cold), static_cast<unsigned>(150 - 120 * cold)),
                         noise(word)});
  }
}

/// A ball that glows, cools to smoke, and is carried off.
void append_blast(const DustPuff& puff, float age, const glm::vec3& at, std::vector<DustInstance>& instances) {
  const float spread = 1 - std::exp(-9 * age), cold = std::min(1.0F, age / ball_life);
  const float left = 1 - age / static_cast<float>(dust_life), drift = std::max(0.0F, age - 0.3F);
  const auto glow = static_cast<unsigned>(255 * (1 - cold) * (1 - cold));
  // From white heat by orange to soot.
  const auto mixed = [&](float hot, float soot) { return static_cast<unsigned>(hot + (soot - hot) * cold); };
  const Rgba colour = rgba(mixed(255, 52), mixed(150, 49), mixed(72, 47), glow);
  for (int i = 0; i < ball_discs; ++i) {
    const std::uint64_t word = static_cast<std::uint64_t>(puff.number * 4 * ball_discs + 4 * i);
    const float angle = 6.2831853F * noise(word), rise = 2 * noise(word + 1) - 0.8F;
    const float level = std::sqrt(std::max(0.0F, 1 - rise * rise)), out = puff.size * (0.25F + 0.75F * noise(word + 2));
    const glm::vec3 way = out * spread * glm::vec3(level * std::cos(angle), level * std::sin(angle), rise);
    const glm::vec3 carried(wind[0] * drift, wind[1] * drift, smoke_speed * drift);
    instances.push_back({at + way + carried, puff.size * (0.35F + 0.45F * spread + 0.12F * age), 0.9F * left * left,
                         colour, noise(word + 3)});
  }
}

/// A lick of flame that rises and goes out, and the smoke that it leaves.
void append_fire(const DustPuff& puff, float age, const glm::vec3& at, std::vector<DustInstance>& instances) {
  constexpr int flames = 3;
  const auto word = static_cast<std::uint64_t>(puff.number) * 16;
  const glm::vec3 aside(puff.size * (noise(word) - 0.5F), puff.size * (noise(word + 1) - 0.5F), 0);
  if (age < flame_life) {
    const float cold = age / flame_life;
    for (int i = 0; i < flames; ++i) {
      // Narrower upwards: a tongue.
      const float above = static_cast<float>(i) / (flames - 1);
      const glm::vec3 own(0.4F * puff.size * (noise(word + 2 + static_cast<std::uint64_t>(i)) - 0.5F), 0,
                          0.9F * puff.size * above);
      const glm::vec3 up(0.25F * wind[0] * age, 0.25F * wind[1] * age, flame_speed * age);
      const float ends = std::min(1.0F, age / 0.12F) * (1 - cold);
      instances.push_back({at + aside + own + up, puff.size * (0.6F - 0.25F * cold) * (1 - 0.55F * above), 0.7F * ends,
                           rgba(255, static_cast<unsigned>(168 - 56 * cold), static_cast<unsigned>(84 - 50 * cold)),
                           noise(word + 5 + static_cast<std::uint64_t>(i))});
    }
  }
  const float late = age - 0.5F * flame_life, left = 1 - age / static_cast<float>(dust_life);
  if (late <= 0) return;
  const glm::vec3 carried(wind[0] * late, wind[1] * late, 0.5F * flame_speed * flame_life + smoke_speed * late);
  instances.push_back({at + aside + carried, puff.size * (0.5F + 0.45F * late),
                       0.3F * left * std::min(1.0F, late / 0.5F), rgba(58, 55, 53) & 0xffffffU, noise(word + 6)});
}

}  // namespace

void append_dust(const std::vector<DustPuff>& puffs, double time, const glm::dvec3& origin,
                 std::vector<DustInstance>& instances) {
  for (const DustPuff& puff : puffs) {
    const auto age = static_cast<float>(time - puff.time);
    if (age < 0 || age >= static_cast<float>(dust_life)) continue;
    const glm::vec3 at(glm::dvec3(puff.position.x(), puff.position.y(), puff.position.z()) - origin);
    switch (puff.kind) {
      case DustPuff::Kind::dust:
        append_cloud(puff, age, at, instances);
        break;
      case DustPuff::Kind::sparks:
        append_sparks(puff, age, at, instances);
        break;
      case DustPuff::Kind::blast:
        append_blast(puff, age, at, instances);
        break;
      case DustPuff::Kind::fire:
        append_fire(puff, age, at, instances);
        break;
    }
  }
}

}  // namespace topple::viewer
