#include <array>
#include <utility>

#include "topple/structure/design_check.h"

namespace topple::structure {

namespace {

using ClauseFormula = std::pair<std::string_view, std::string_view>;
constexpr std::array<ClauseFormula, 15> formulas{{
    {"EN 1993-1-1 6.2.1 (6.2)", "N_Ed/N_Rd + M_y,Ed/M_y,V,Rd + M_z,Ed/M_z,V,Rd"},
    {"EN 1993-1-1 6.2.6 (6.17)", "V_Ed/V_pl,Rd + T_Ed/T_Rd"},
    {"EN 1993-1-1 6.2.7 (6.23)", "T_Ed/T_Rd"},
    {"EN 1993-1-1 6.3.1 (6.46)", "N_Ed/(min(chi_y, chi_z, chi_T) A f_y/gamma_M1)"},
    {"EN 1993-1-1 6.3.2 (6.54)", "M_y,Ed/(chi_LT W_y f_y/gamma_M1)"},
    {"EN 1993-1-1 6.3.3 (6.61)",
     "N_Ed/(chi_y N_Rk/gamma_M1) + k_yy M_y,Ed/(chi_LT M_y,Rk/gamma_M1) + k_yz M_z,Ed/(M_z,Rk/gamma_M1)"},
    {"EN 1993-1-1 6.3.3 (6.62)",
     "N_Ed/(chi_z N_Rk/gamma_M1) + k_zy M_y,Ed/(chi_LT M_y,Rk/gamma_M1) + k_zz M_z,Ed/(M_z,Rk/gamma_M1)"},
    {"AISC 360 D2", "P_u/(phi_t P_n), P_n = F_y A_g"},
    {"AISC 360 E1", "P_u/(phi_c P_n), P_n = F_cr A_e (E3, E4, E7)"},
    {"AISC 360 F1", "max(M_ux/(phi_b M_nx), M_uy/(phi_b M_ny)) (F2 to F8, F11)"},
    {"AISC 360 G1", "max over both axes of V_u/(phi_v V_n), V_n = 0.6 F_y A_w C_v"},
    {"AISC 360 H1-1",
     "P_u/P_c >= 0.2: P_u/P_c + 8/9 (M_ux/M_cx + M_uy/M_cy); else P_u/(2 P_c) + M_ux/M_cx + M_uy/M_cy"},
    {"AISC 360 H1-1 (tension)",
     "P_u/P_c >= 0.2: P_u/P_c + 8/9 (M_ux/M_cx + M_uy/M_cy); else P_u/(2 P_c) + M_ux/M_cx + M_uy/M_cy, P_u in tension"},
    {"AISC 360 H3-1", "T_u/(phi_T T_n)"},
    {"AISC 360 H3-6", "P_u/P_c + M_u/M_c + (V_u/V_c + T_u/T_c)^2"},
}};

}  // namespace

std::string_view design_formula(std::string_view clause) {
  for (const ClauseFormula& entry : formulas)
    if (entry.first == clause) return entry.second;
  return {};
}

std::string_view design_code_name(DesignCode code) {
  return code == DesignCode::en1993 ? "EN 1993-1-1:2005, gamma_M0 = gamma_M1 = 1.0" : "AISC 360-16, LRFD";
}

}  // namespace topple::structure
