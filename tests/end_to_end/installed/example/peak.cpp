// peak STUDY AT: the largest displacement of the study's first mass at one point, such as "r=0.9,f=0.1".
#include <cstdio>
#include <exception>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/settings.hpp"

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const frahm::studies::Study study = frahm::studies::read_study_with(argv[1], {});
  std::vector<double> parameters = frahm::studies::parameters_at(study, {argv[2]});
  frahm::mechanics::NetworkValues values;
  frahm::studies::evaluate(study.values, study.parameters, parameters, values);

  frahm::periodic::PeriodicResponse response(study.network, {{frahm::periodic::Measure::peak, 0}});
  response.set_values(values);
  response.solve();
  double peak = 0.0;
  response.quantities({&peak, 1});
  std::printf("%.15g\n", peak);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
