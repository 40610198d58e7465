#pragma once
// Saint-Venant torsion of solid and open sections.

namespace topple::structure {

/// Torsion constant of a rectangle (Timoshenko & Goodier, Theory of Elasticity, art. 109: the series in tanh).
[[nodiscard]] double rectangle_torsion_constant(double depth, double width);

/// Torque over peak shear stress of a rectangle; the peak is at the middle of the long side (same article).
[[nodiscard]] double rectangle_torsion_modulus(double depth, double width);

/// Torsion constant of a doubly symmetric I with fillets (El Darwish & Johnston, "Torsion of structural shapes", ASCE
/// Journal of the Structural Division 91 (1965)): the plates, their junctions and what the flange tips lose.
[[nodiscard]] double I_torsion_constant(double depth, double width, double web, double flange, double fillet);

}  // namespace topple::structure
