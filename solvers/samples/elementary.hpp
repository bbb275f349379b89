#pragma once

// Functions of one number by + - * / and the square root alone, which IEEE 754 rounds in one way: the same
// bits on every machine and with every mathematical library. Relative errors below 1e-15, of normal_share
// 1e-14.
namespace frahm::samples {

double exponential(double x);
double logarithm(double x);           // x > 0, no subnormal
double logarithm_of_1_and(double x);  // log(1 + x), x > -1

// The share of a standard normal distribution below x.
double normal_share(double x);
// The number below which a share of it lies; infinite for the shares 0 and 1 and beyond.
double standard_normal(double share);

}  // namespace frahm::samples
