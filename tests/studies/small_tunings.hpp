#pragma once

#include <string>

// Small tunings as texts, for the tests of what is made from them.
namespace small_tunings {

inline const std::string heading =
    "[study]\nschema = 1\nkind = \"tune\"\ntitle = \"small\"\nunits = \"dimensionless\"\n";

// A mass on a spring under a harmonic force with an absorber of mass ratio mu, tuning f and damping ratio
// zeta.
inline const std::string absorber =
    "[parameters]\nr = 1\nmu = 0.05\nf = 0.9\nzeta = 0.2\nP = 1\n"
    "[[mass]]\nname = \"main\"\nmass = 1\n[[mass]]\nname = \"tmd\"\nmass = \"mu\"\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 1\n"
    "[[element]]\nname = \"tmd_spring\"\ntype = \"spring\"\nbetween = [\"main\", \"tmd\"]\n"
    "stiffness = \"mu*f^2\"\n"
    "[[element]]\nname = \"tmd_damper\"\ntype = \"damper\"\nbetween = [\"main\", \"tmd\"]\n"
    "damping = \"2*mu*zeta*f\"\n"
    "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"main\"\namplitude = \"P\"\n";

inline const std::string minimax =
    "[tune]\nobjective = \"minimax\"\nquantity = \"main_peak\"\n"
    "band = { parameter = \"r\", from = 0.7, to = 1.3 }\n";

inline const std::string of_f = "[[design]]\nparameter = \"f\"\nlower = 0.7\nupper = 1.2\n";
inline const std::string of_zeta = "[[design]]\nparameter = \"zeta\"\nlower = 0.01\nupper = 0.5\n";

// The classical tuned mass damper.
inline const std::string classical = heading + absorber + minimax + of_f + of_zeta;

}  // namespace small_tunings
