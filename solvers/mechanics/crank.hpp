#pragma once

#include <vector>

namespace frahm::mechanics {

// Displacement of a slider driven by a crank of radius R [m] and a rod of length L [m], R < L, at the crank
// angle theta, measured from the rod's length:
//
//   a(theta) = R sin(theta) + sqrt(L^2 - R^2 cos^2(theta)) - L
//            = R sin(theta) + sum_{m >= 0} even[m] cos(2 m theta)
//
// The rod's part is periodic with pi, so only even orders join the first.
// taylor_order 1, 2 or 4: of the Taylor series in R/L cut there,
//   a = R sin(theta) - R^2 cos^2(theta) / (2 L) - R^4 cos^4(theta) / (8 L^3);   0: exact.
double crank_displacement(double radius, double rod, double theta, int taylor_order = 0);

// even[m], m = 0 .. count [m]: by the trapezoidal rule, which converges as fast as the series does.
std::vector<double> crank_even_orders(double radius, double rod, int count, int taylor_order = 0);

// The derivative of crank_even_orders along a change of radius and rod by radius_by and rod_by [m per unit].
std::vector<double> crank_even_orders_derivative(double radius, double rod, double radius_by, double rod_by,
                                                 int count, int taylor_order = 0);

// The number of even orders after which the rest is below 1e-15 R, at most kMostEvenOrders, enough up to
// kLargestCrankRatio.  ratio = R/L in (0, 1).
int crank_orders_needed(double ratio);
inline constexpr int kMostEvenOrders = 40;
inline constexpr double kLargestCrankRatio = 0.9;

}  // namespace frahm::mechanics
