#pragma once
// OpenSees' shell cases with each element cut up. An edge both of whose nodes are held is held between them as both
// are: cut up it is the same structure.
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/shared_data.h"
#include "topple/structure/formats/files.h"

namespace topple::test {

/// `name`: of a case of reference/opensees. Its nodes come first, in their order.
inline structure::Building cut_up(const std::string& name, int parts) {
  std::ifstream stream(shared_path("reference/opensees/" + name + ".json"));
  using Json = nlohmann::ordered_json;  // parts stay in the order of the file
  const Json model = Json::parse(stream);
  Json finer = model;
  for (auto& [panel, values] : finer.at("panels").items()) {
    values["mesh"] = parts;
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const auto node = [&](std::size_t i) { return values.at("nodes").at(i % 4).get<std::string>(); };
      const Json& supports = model.at("supports");
      if (!supports.contains(node(edge)) || !supports.contains(node(edge + 1))) continue;
      Json held = Json::object();
      for (const auto& [component, kind] : supports.at(node(edge)).items())
        if (supports.at(node(edge + 1)).contains(component)) held[component] = true;
      if (!held.empty()) finer["supports"][panel + ":" + std::to_string(edge + 1)] = held;
    }
  }
  return structure::parse_model(finer.dump(), name + ".json");
}

}  // namespace topple::test
