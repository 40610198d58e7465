#pragma once
// The example of the model format, without what only shells and meshes have, as a text for tests to change.
#include <stdexcept>
#include <string>

namespace topple::test {

inline const std::string example_model = R"({
  "topple": 1,
  "title": "Two bays",
  "units": {"length": "m", "force": "N", "mass": "kg"},
  "gravity": 9.80665,
  "materials": {
    "S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 355e6, "thermal_expansion": 1.2e-5},
    "C30":  {"youngs_modulus": 33e9, "shear_modulus": 13.75e9, "density": 2500, "compressive_strength": 30e6, "tensile_strength": 2.9e6}
  },
  "sections": {
    "col":  {"shape": "I", "depth": 0.30, "width": 0.30, "web": 0.011, "flange": 0.019, "fillet": 0.027},
    "tube": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.015},
    "w14":  {"catalogue": "W14x48"},
    "raw":  {"area": 0.01, "Iy": 1e-4, "Iz": 1e-5, "J": 1e-6, "shear_area_y": 0.004, "shear_area_z": 0.006,
             "plastic_modulus_y": 7e-4, "plastic_modulus_z": 2e-4, "torsion_modulus": 2e-5, "depth": 0.3, "width": 0.2}
  },
  "joints": {
    "given":    {"capacity": {"tension": 2e6, "compression": 8e6, "shear_y": 5e5, "shear_z": 5e5, "torsion": 1e5, "moment_y": 6e5, "moment_z": 2e5}, "strength": 1.0},
    "derived":  {"capacity": {"from": "section", "ratio": 0.8, "torsion": 5e4}},
    "original": {"capacity": {"force": [9e6, 4e5, 4e5], "moment": [1e5, 6e5, 6e5]}, "strength": 1.5},
    "ductile":  {"capacity": {"from": "section", "ratio": 1.0}, "ductility": {"moment_y": 0.03, "moment_z": 0.03}},
    "pin":      {"stiffness": {"ry": 0, "rz": 0}, "capacity": {"from": "section", "ratio": 0.5}},
    "spring":   {"stiffness": {"ry": 4e7}},
    "edge":     {"capacity_per_length": {"tension": 4e5, "compression": 4e6, "shear_y": 4e5, "shear_z": 2e5}}
  },
  "nodes": {"A0": [0, 0, 0], "A1": [0, 0, 3.5], "B0": [6, 0, 0], "B1": [6, 0, 3.5],
            "C0": [6, 6, 0], "C1": [6, 6, 3.5], "D0": [0, 6, 0], "D1": [0, 6, 3.5]},
  "members": {
    "PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "col", "material": "S355", "up": [1, 0, 0], "roll": 0, "joints": ["given", null], "groups": ["west"]},
    "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "col", "material": "S355", "joints": ["given", null]},
    "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "col", "material": "S355", "joints": ["original", null]},
    "PD": {"kind": "post", "nodes": ["D0", "D1"], "section": "col", "material": "S355", "joints": ["given", null]},
    "AB": {"kind": "beam", "nodes": ["A1", "B1"], "section": "w14", "material": "S355", "joints": ["derived", "pin"], "offsets": [[0.15, 0, 0], [-0.15, 0, 0]]},
    "BC": {"kind": "beam", "nodes": ["B1", "C1"], "section": "w14", "material": "S355", "joints": ["derived", "derived"]},
    "CD": {"kind": "beam", "nodes": ["C1", "D1"], "section": "w14", "material": "S355", "joints": ["ductile", "spring"]},
    "DA": {"kind": "beam", "nodes": ["D1", "A1"], "section": "raw", "material": "S355", "joints": ["derived", "derived"]},
    "X1": {"kind": "brace", "nodes": ["A0", "B1"], "section": "tube", "material": "S355", "axial": "tension"}
  },
  "panels": {
    "S1": {"kind": "slab", "nodes": ["A1", "B1", "C1", "D1"], "thickness": 0.2, "material": "C30", "model": "membrane", "span": "two-way", "joint": "edge"},
    "W1": {"kind": "wall", "nodes": ["A0", "B0", "B1", "A1"], "thickness": 0.15, "material": "C30", "model": "shell", "mesh": [4, 3],
           "openings": [[[1.5, 0], [2.5, 0], [2.5, 2.1], [1.5, 2.1]]], "joint": "edge"}
  },
  "supports": {"A0": "fixed", "B0": "pinned", "C0": {"x": true, "y": true, "z": 5e7}, "D0": "fixed", "W1:1": "pinned"},
  "diaphragms": {"level 1": ["A1", "B1", "C1", "D1"]},
  "masses": {"nodes": {"A1": 1200}, "loads": {"live": 0.2}},
  "loads": {
    "dead": {"self_weight": 1.0, "panels": {"S1": {"pressure": 1500}}},
    "live": {"panels": {"S1": {"pressure": 3000}}, "nodes": {"B1": {"z": -5e4, "rx": 0}},
             "members": {"BC": [{"uniform": {"z": -8e3}},
                                {"trapezoid": {"z": [-1e3, -4e3]}, "from": 1.0, "to": 3.0},
                                {"point": {"y": 2e3, "rz": 1e2}, "at": 2.5, "frame": "local"},
                                {"temperature": {"uniform": 20, "gradient_y": 0, "gradient_z": 15}}]}},
    "settle": {"settlements": {"B0": {"z": -0.01}}}
  },
  "combinations": {"service": {"dead": 1, "live": 1}, "collapse": {"dead": 1.2, "live": 0.5}}
})";

/// `text` with the first `from` replaced; a test that asks for what is not there is wrong.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the example has no " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace topple::test
