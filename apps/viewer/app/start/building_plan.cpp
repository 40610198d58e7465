#include "app/start/building_plan.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

using Json = nlohmann::ordered_json;

void require(const char* what, double value, double low, double high) {
  if (value >= low && value <= high) return;
  const auto text = [](double x) { return Json(x).dump(); };
  throw structure::InputError(std::string("new building: ") + what + ": found " + text(value) +
                              "; accepted: " + text(low) + " to " + text(high));
}

void check(const BuildingPlan& plan) {
  for (const int posts : plan.posts) require("posts", posts, 2, 20);
  require("storeys", plan.storeys, 1, 60);
  for (const double bay : plan.bay) require("bay", bay, 1, 15);
  require("storey height", plan.storey_height, 2, 8);
  require("post width", plan.post_width, 0.1, 2);
  require("beam depth", plan.beam_depth, 0.1, 2);
  require("floor thickness", plan.floor_thickness, 0.05, 1);
  require("wall thickness", plan.wall_thickness, 0.05, 1);
}

/// N and N m, to three digits: more would pretend.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

constexpr double concrete_strength = 25e6, bar_strength = 500e6, steel_share = 0.01;

/// Of a rectangle of concrete with a hundredth of steel, half of it on each face, and links as shear needs them at the
/// flattest strut: EN 1992-1-1, 6.1 with rectangular stress blocks, 6.2.3 with cot(theta) = 1 and nu = 0.54, 6.3.
Json concrete_capacity(double width, double depth) {
  const double area = width * depth, bars = steel_share * area;
  const auto moment = [&](double b, double h) {
    const double pull = bars / 2 * bar_strength, block = pull / (b * concrete_strength);
    return pull * (0.9 * h - block / 2);
  };
  const auto shear = [&](double b, double h) {
    const double links = 0.0025 * b * 0.8 * h * bar_strength, strut = 0.54 * concrete_strength * b * 0.8 * h / 2;
    return std::min(links, strut);
  };
  const double smaller = std::min(width, depth), wall = area / (2 * (width + depth));
  const double torsion = 2 * 0.15 * concrete_strength / 3 * (area * 0.6) * std::min(wall, smaller / 4);
  return {{"tension", rounded(bars * bar_strength)},
          {"compression", rounded(area * concrete_strength + bars * bar_strength)},
          {"shear_y", rounded(shear(depth, width))},
          {"shear_z", rounded(shear(width, depth))},
          {"torsion", rounded(torsion)},
          {"moment_y", rounded(moment(width, depth))},
          {"moment_z", rounded(moment(depth, width))}};
}

void add_concrete_frame(Json& model, const BuildingPlan& plan) {
  const double post = plan.post_width, depth = plan.beam_depth, width = depth / 2;
  model["sections"] = {{"post", {{"shape", "rectangle"}, {"depth", post}, {"width", post}}},
                       {"beam", {{"shape", "rectangle"}, {"depth", depth}, {"width", width}}}};
  model["joints"]["post"]["capacity"] = concrete_capacity(post, post);
  model["joints"]["beam"]["capacity"] = concrete_capacity(width, depth);
}

void add_steel_frame(Json& model, const BuildingPlan& plan) {
  const double post = plan.post_width, depth = plan.beam_depth;
  model["materials"]["steel"] = {
      {"youngs_modulus", 210e9}, {"poisson_ratio", 0.3}, {"density", 7850}, {"yield_strength", 355e6}};
  model["sections"] = {
      {"post", {{"shape", "box"}, {"depth", post}, {"width", post}, {"thickness", post / 20}}},
      {"beam", {{"shape", "I"}, {"depth", depth}, {"width", depth / 2}, {"web", depth / 45}, {"flange", depth / 28}}}};
  model["joints"]["post"]["capacity"] = {{"from", "section"}, {"ratio", 1.0}};
  model["joints"]["beam"]["capacity"] = {{"from", "section"}, {"ratio", 0.8}};
}

Json generator(const BuildingPlan& plan) {
  const char* material = plan.frame == FrameKind::steel ? "steel" : "concrete";
  Json building = {{"posts", plan.posts},
                   {"storeys", plan.storeys},
                   {"bay", plan.bay},
                   {"storey_height", plan.storey_height},
                   {"post", {{"section", "post"}, {"material", material}, {"joint", "post"}}},
                   {"beam", {{"section", "beam"}, {"material", material}, {"joint", "beam"}}},
                   {"base", "fixed"}};
  if (plan.floors)
    building["slab"] = {{"thickness", plan.floor_thickness},
                        {"material", "concrete"},
                        {"joint", "floor"},
                        {"model", "membrane"},
                        {"pressure", {{"dead", 1000}, {"live", 2000}}}};
  constexpr std::array<const char*, 4> sides{"x-", "x+", "y-", "y+"};
  Json chosen = Json::array();
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (plan.walls[i]) chosen.push_back(sides[i]);
  if (!chosen.empty())
    building["wall"] = {{"thickness", plan.wall_thickness},
                        {"material", "brick"},
                        {"joint", "mortar"},
                        {"model", "cladding"},
                        {"sides", chosen}};
  return building;
}

}  // namespace

std::string make_model_text(const BuildingPlan& plan) {
  check(plan);
  Json model;
  model["topple"] = 1;
  model["title"] = plan.title;
  const auto cells = [](double size) { return Json{{"method", "voronoi"}, {"cell", size}}; };
  model["materials"]["concrete"] = {{"youngs_modulus", 30e9},    {"poisson_ratio", 0.2},
                                    {"density", 2400},           {"compressive_strength", concrete_strength},
                                    {"tensile_strength", 2.6e6}, {"fracture", cells(0.9)}};
  model["materials"]["brick"] = {{"youngs_modulus", 5e9},       {"poisson_ratio", 0.15},      {"density", 1800},
                                 {"compressive_strength", 6e6}, {"tensile_strength", 0.25e6}, {"fracture", cells(0.5)}};
  plan.frame == FrameKind::steel ? add_steel_frame(model, plan) : add_concrete_frame(model, plan);
  // Floors with 0.5 % of steel across their edges; mortar at 0.1 MPa in tension.
  const double floor = plan.floor_thickness, wall = plan.wall_thickness;
  model["joints"]["floor"]["capacity_per_length"] = {{"tension", rounded(0.005 * floor * bar_strength)},
                                                     {"compression", rounded(floor * concrete_strength / 2)},
                                                     {"shear_y", rounded(0.005 * floor * bar_strength / 2)},
                                                     {"shear_z", rounded(0.4e6 * floor)}};
  model["joints"]["mortar"]["capacity_per_length"] = {{"tension", rounded(0.1e6 * wall)},
                                                      {"compression", rounded(3e6 * wall)},
                                                      {"shear_y", rounded(0.2e6 * wall)},
                                                      {"shear_z", rounded(0.1e6 * wall)}};
  model["building"] = generator(plan);
  model["loads"] = {{"dead", {{"self_weight", 1.0}}}, {"live", Json::object()}};
  model["combinations"] = {{"service", {{"dead", 1}, {"live", 1}}}, {"collapse", {{"dead", 1}, {"live", 0.5}}}};
  return model.dump(2) + "\n";
}

}  // namespace topple::viewer
