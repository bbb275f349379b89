#pragma once

#include <string>

// Small studies as texts, for the tests of what is made from a study.
namespace small_studies {

// One mass on a spring and a damper with friction under a harmonic force, without an axis.
inline std::string oscillator(const std::string& stiffness = "1") {
  return "[study]\nschema = 1\nkind = \"sweep\"\ntitle = \"small\"\nunits = \"dimensionless\"\n"
         "[parameters]\nr = 0.9\nf = 0.2\nzeta = 0.05\nk = 1\n"
         "[[mass]]\nname = \"main\"\nmass = 1\n"
         "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = " +
         stiffness +
         "\n[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"ground\", \"main\"]\n"
         "damping = \"2*zeta\"\n"
         "[[element]]\nname = \"friction\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"main\"]\nforce = "
         "\"f\"\n"
         "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"main\"\namplitude = 1\n";
}

inline std::string axis(const std::string& parameter, double from, double to, int points,
                        const std::string& more = "") {
  return "[[axis]]\nparameter = \"" + parameter + "\"\nfrom = " + std::to_string(from) +
         "\nto = " + std::to_string(to) + "\npoints = " + std::to_string(points) + "\n" + more;
}

inline std::string axis_of(const std::string& parameter, const std::string& values,
                           const std::string& more = "") {
  return "[[axis]]\nparameter = \"" + parameter + "\"\nvalues = " + values + "\n" + more;
}

// A chain of unit masses from the ground, with friction in every so many storeys, over so many frequencies.
inline std::string building(int storeys, int every, int frequencies) {
  std::string text =
      "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 0.1\n";
  for (int i = 1; i <= storeys; ++i) {
    const std::string floor = "floor" + std::to_string(i);
    const std::string below = i == 1 ? "ground" : "floor" + std::to_string(i - 1);
    const auto element = [&](const std::string& type, const std::string& value) {
      text += "[[element]]\nname = \"" + type + std::to_string(i) + "\"\ntype = \"" + type +
              "\"\nbetween = [\"" + below + "\", \"" + floor + "\"]\n" + value + "\n";
    };
    text += "[[mass]]\nname = \"" + floor + "\"\nmass = 1\n";
    element("spring", "stiffness = 1");
    element("damper", "damping = 0.02");
    if (i % every == 0) element("coulomb", "force = 0.01");
  }
  text += "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"floor" + std::to_string(storeys) +
          "\"\namplitude = 0.1\n";
  return text + axis("r", 0.02, 0.2, frequencies);
}

}  // namespace small_studies
