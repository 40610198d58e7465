#include "simulation/debris/bodies.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace topple::structure {

namespace {

void insert(std::vector<std::int64_t>& ids, std::int64_t id) {
  ids.insert(std::lower_bound(ids.begin(), ids.end(), id), id);
}

void remove(std::vector<std::int64_t>& ids, std::int64_t id) {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found != ids.end() && *found == id) ids.erase(found);
}

auto find_motion(std::vector<BodyMotion>& motions, std::int64_t id) {
  return std::lower_bound(motions.begin(), motions.end(), id,
                          [](const BodyMotion& one, std::int64_t wanted) { return one.id < wanted; });
}

}  // namespace

Body& Bodies::add(std::int64_t id, Body one) {
  const auto [entry, made] = all_.emplace(id, std::move(one));
  if (!made) throw std::invalid_argument("body " + std::to_string(id) + " is there already");
  Body& body = entry->second;
  BodyMotion motion;
  motion.id = id;
  motion.body = &body;
  motion.mass = body.rest.mass;
  motion.reach = body.bounds.low.cwiseAbs().cwiseMax(body.bounds.high.cwiseAbs()).norm();
  motions_.insert(find_motion(motions_, id), motion);
  if (body.members.empty() && body.panels.size() == 1) insert(single_panels_, id);
  if (body.members.size() + body.panels.size() > 1 && !body.members.empty()) insert(composed_, id);
  return body;
}

void Bodies::erase(std::int64_t id) {
  if (all_.erase(id) == 0) return;
  motions_.erase(find_motion(motions_, id));
  remove(single_panels_, id);
  remove(composed_, id);
}

BodyMotion& Bodies::motion(std::int64_t id) {
  const auto found = find_motion(motions_, id);
  if (found == motions_.end() || found->id != id)
    throw std::out_of_range("body " + std::to_string(id) + " is not there");
  return *found;
}

}  // namespace topple::structure
