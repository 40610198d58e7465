#include <array>
#include <utility>

#include "topple/structure/design_check.h"

namespace topple::structure {

namespace {

using ClauseFormula = std::pair<std::string_view, std::string_view>;
constexpr std::array<ClauseFormula, 24> formulas{{
    {"EN 1993-1-1 6.2.1 (6.2)", "N_Ed/N_Rd + M_y,Ed/M_y,V,Rd + M_z,Ed/M_z,V,Rd"},
    {"EN 1993-1-1 6.2.6 (6.17)", "V_Ed/V_pl,Rd + T_Ed/T_Rd"},
    {"EN 1993-1-1 6.2.7 (6.23)", "T_Ed/T_Rd"},
    {"EN 1993-1-1 6.2.7(5) (6.1)",
     "max(sqrt(sigma_x^2 + 3 tau_t^2), sqrt(3) (tau_t + tau_w + tau_V))/(f_y/gamma_M0), sigma_x = N/A + M_y/W_el,y + "
     "M_z/W_el,z + sigma_w"},
    {"EN 1993-1-1 6.2.7(6) (6.2)", "N_Ed/N_Rd + M_y,Ed/M_y,Rd + M_z,Ed/M_z,Rd + B_Ed/B_el,Rd"},
    {"EN 1993-1-5 5.2 (5.10)", "V_Ed/V_b,Rd, V_b,Rd = V_bw,Rd + V_bf,Rd <= eta f_yw h_w t_w/(sqrt(3) gamma_M1)"},
    {"EN 1993-1-5 7.1 (7.1)", "M_Ed/M_pl,Rd + (1 - M_f,Rd/M_pl,Rd) (2 V_Ed/V_bw,Rd - 1)^2"},
    {"EN 1993-1-5 8 (8.1)", "(h_w/t_w)/(k E/f_yf sqrt(A_w/A_fc))"},
    {"EN 1993-6 A (A.1)",
     "M_y,Ed/(chi_LT M_y,Rk/gamma_M1) + C_mz M_z,Ed/(M_z,Rk/gamma_M1) + k_w k_zw k_alpha B_Ed/(B_Rk/gamma_M1)"},
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
    {"AISC 360 H3-7", "(P/A + M_x/S_x + M_y/S_y + sigma_w)/(phi_T F_y)"},
    {"AISC 360 H3-8", "tau_u/(phi_T 0.6 F_y)"},
    {"AISC 360 H3-9", "P_u/P_c + M_ux/M_cx + M_uy/M_cy + sigma_w/(phi_T F_y)"},
    {"AISC 360 H3-6", "P_u/P_c + M_u/M_c + (V_u/V_c + T_u/T_c)^2"},
}};

}  // namespace

std::string_view design_formula(std::string_view clause) {
  for (const ClauseFormula& entry : formulas)
    if (entry.first == clause) return entry.second;
  return {};
}

constexpr std::array<std::string_view, 10> not_in_en1993{
    "6.2.2, 6.2.3(2)b, 6.2.5(4): holes, net sections and connections (EN 1993-1-8)",
    "6.2.9.1: plastic interaction of axial force and bending beyond the straight line of (6.2)",
    "6.3.2.1(2): loads above the shear centre; M_cr is that of loads at the shear centre and ends free to warp",
    "6.3.5: members with plastic hinges; 6.4: built-up compression members",
    "7: deflections and vibrations, but storey drift against the limit that is given",
    "EN 1993-1-5 3: shear lag; 6: transverse forces (patch loading); 9: stiffeners, which are assumed at every support",
    "EN 1993-1-6: tubes of class 4; sections given as numbers are of class 3, without shear buckling",
    "sections given as numbers: W = 2 I/depth, 2 I/width; unless symmetric, depth and width are twice the farthest "
    "fibre",
    "EN 1993-1-9: fatigue; EN 1993-1-10: brittle fracture; EN 1993-1-2: fire",
    "5.3: imperfections of the structure as a whole, but where they are loads of the model"};
constexpr std::array<std::string_view, 9> not_in_aisc360{
    "D2(b), D3: rupture of net sections; F13.1: holes in tension flanges; J: connections",
    "E5: single angles; E6: built-up members; E4 for sections given as numbers",
    "sections given as numbers: S = 2 I/depth, 2 I/width; unless symmetric, depth and width are twice the farthest "
    "fibre",
    "F1: loads above the shear centre, which lower lateral-torsional buckling",
    "F9, F10: tees, double and single angles",
    "G2.2: tension field action (on the safe side); G2.3: stiffeners, where their spacing is given",
    "G7: webs with openings; J10: concentrated forces on flanges and webs",
    "C: the required strengths are those of the analysis that was asked for",
    "L: serviceability, but storey drift against the limit that is given"};

std::string_view design_code_name(DesignCode code) {
  return code == DesignCode::en1993 ? "EN 1993-1-1:2005, EN 1993-1-5:2006, gamma_M0 = gamma_M1 = 1.0"
                                    : "AISC 360-16, LRFD";
}

std::span<const std::string_view> design_not_checked(DesignCode code) {
  if (code == DesignCode::en1993) return not_in_en1993;
  return not_in_aisc360;
}

}  // namespace topple::structure
