#pragma once
// The tables of a model and their columns, shared by reader and writer. docs/other-formats.md has their meaning.
#include <array>
#include <string_view>
#include <vector>

namespace topple::structure {

namespace model_tables {

using Columns = std::vector<std::string_view>;

inline const Columns model{"key", "value"};
inline const Columns nodes{"name", "x", "y", "z"};
inline const Columns materials{
    "name",           "youngs_modulus",       "shear_modulus",    "poisson_ratio",    "density",
    "yield_strength", "compressive_strength", "tensile_strength", "thermal_expansion"};
inline const Columns sections{"name",
                              "shape",
                              "depth",
                              "width",
                              "web",
                              "flange",
                              "fillet",
                              "thickness",
                              "diameter",
                              "catalogue",
                              "area",
                              "Iy",
                              "Iz",
                              "J",
                              "shear_area_y",
                              "shear_area_z",
                              "plastic_modulus_y",
                              "plastic_modulus_z",
                              "torsion_modulus",
                              "shear_deformation"};
inline const Columns joints{"name",
                            "strength",
                            "tension",
                            "compression",
                            "shear_y",
                            "shear_z",
                            "torsion",
                            "moment_y",
                            "moment_z",
                            "x",
                            "y",
                            "z",
                            "rx",
                            "ry",
                            "rz",
                            "from",
                            "ratio",
                            "interaction",
                            "ductility_torsion",
                            "ductility_moment_y",
                            "ductility_moment_z"};
inline const Columns members{
    "name", "kind", "node1", "node2", "section", "material", "upx", "upy", "upz", "roll", "joint1", "joint2", "groups",
    "axial", "offset1x", "offset1y", "offset1z", "offset2x", "offset2y", "offset2z",
    // `design`: "none", or what follows
    "design", "length_y", "length_z", "length_torsion", "factor_y", "factor_z", "factor_torsion", "restraints",
    "moment_factor", "equivalent_moment_y", "equivalent_moment_z", "stiffener_spacing"};
inline constexpr std::size_t design_column = 20, restraints_column = 27;
inline const Columns restraints{"member", "at"};
inline const Columns panels{"name",     "kind",  "node1", "node2", "node3", "node4", "thickness",
                            "material", "model", "mesh",  "joint", "span",  "groups"};
inline const Columns openings{"panel", "opening", "x", "y"};
inline const Columns diaphragms{"name", "node"};
inline const Columns cuts{"name",     "x",       "y",       "z",       "normal_x", "normal_y",
                          "normal_z", "along_x", "along_y", "along_z", "parts"};
inline const Columns masses{"on", "name", "value", "Ixx", "Iyy", "Izz"};
inline const Columns supports{"node", "x", "y", "z", "rx", "ry", "rz"};
inline const Columns loads{"case", "on", "name", "type", "component", "value", "value2", "from", "to", "frame"};
inline const Columns combinations{"name", "case", "factor"};

struct Table {
  std::string_view file;
  const Columns* columns;
};
/// In the order in which they are written.
inline const std::array<Table, 15> all{{{"model.csv", &model},
                                        {"materials.csv", &materials},
                                        {"sections.csv", &sections},
                                        {"joints.csv", &joints},
                                        {"nodes.csv", &nodes},
                                        {"members.csv", &members},
                                        {"restraints.csv", &restraints},
                                        {"panels.csv", &panels},
                                        {"openings.csv", &openings},
                                        {"supports.csv", &supports},
                                        {"diaphragms.csv", &diaphragms},
                                        {"masses.csv", &masses},
                                        {"loads.csv", &loads},
                                        {"combinations.csv", &combinations},
                                        {"cuts.csv", &cuts}}};

/// Names of groups in one cell stand between these.
inline constexpr char group_separator = ';';

/// What a row of loads.csv acts on, or one of masses.csv belongs to.
inline constexpr std::string_view on_model = "model", on_node = "node", on_member = "member", on_panel = "panel",
                                  on_settlement = "settlement", on_load = "load";

}  // namespace model_tables

}  // namespace topple::structure
