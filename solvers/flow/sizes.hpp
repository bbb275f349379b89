#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "solvers/flow/polynomial.hpp"

namespace frahm::periodic {

using ContactMask = std::uint64_t;  // bit j: contact j
inline constexpr int kMostContacts = 64;
inline bool contains(ContactMask mask, Eigen::Index contact) {
  return (mask >> contact) & 1U;
}
inline ContactMask bit(Eigen::Index contact) {
  return ContactMask{1} << contact;
}
inline Eigen::Index count(ContactMask mask) {
  return __builtin_popcountll(mask);
}
inline Eigen::Index first(ContactMask mask) {
  return __builtin_ctzll(mask);
}
inline std::vector<Eigen::Index> list_of(ContactMask mask) {
  std::vector<Eigen::Index> contacts;
  for (; mask != 0; mask &= mask - 1) contacts.push_back(first(mask));
  return contacts;
}

// Sizes and types of a system of N masses under H harmonics. Known at compile time for the systems of which
// maps of millions of points are made; Eigen::Dynamic for all others. Contacts: at most kMaxContacts, then
// Dynamic. Internal forces (of Maxwell elements, and of laws with a spring in series): none, then Dynamic.
template <int N, int H>
struct Sizes {
  static constexpr bool is_fixed = N != Eigen::Dynamic;
  static constexpr int kInternal = is_fixed ? 0 : Eigen::Dynamic;
  static constexpr int kState = is_fixed ? 2 * N : Eigen::Dynamic;
  static constexpr int kOscillators = is_fixed ? 1 + 2 * H : Eigen::Dynamic;
  static constexpr int kMaxContacts = is_fixed ? 4 : Eigen::Dynamic;

  using Vector = Eigen::Matrix<double, N, 1>;
  using Square = Eigen::Matrix<double, N, N>;
  using State = Eigen::Matrix<double, kState, 1>;  // displacements, velocities, internal forces
  using Internal = Eigen::Matrix<double, kInternal, 1>;
  using VectorByInternal = Eigen::Matrix<double, N, kInternal>;
  using InternalByOscillators = Eigen::Matrix<double, kInternal, kOscillators>;
  using ContactsByInternal =
      Eigen::Matrix<double, Eigen::Dynamic, kInternal, Eigen::ColMajor, kMaxContacts, kInternal>;
  using StateSquare = Eigen::Matrix<double, kState, kState>;
  using Oscillators = Eigen::Matrix<double, kOscillators, 1>;  // 1, cos, sin of each harmonic's phase
  using OscillatorRow = Eigen::Matrix<double, 1, kOscillators>;
  using VectorByOscillators = Eigen::Matrix<double, N, kOscillators>;
  using StateByOscillators = Eigen::Matrix<double, kState, kOscillators>;
  using VectorByContacts =
      Eigen::Matrix<double, N, Eigen::Dynamic, N == 1 ? Eigen::RowMajor : Eigen::ColMajor, N, kMaxContacts>;
  using StateByContacts =
      Eigen::Matrix<double, kState, Eigen::Dynamic, Eigen::ColMajor, kState, kMaxContacts>;
  using ContactsByVector =
      Eigen::Matrix<double, Eigen::Dynamic, N, N == 1 ? Eigen::ColMajor : Eigen::RowMajor, kMaxContacts, N>;
  using ContactsByOscillators =
      Eigen::Matrix<double, Eigen::Dynamic, kOscillators, Eigen::RowMajor, kMaxContacts, kOscillators>;
  using ContactsByState =
      Eigen::Matrix<double, Eigen::Dynamic, kState, Eigen::RowMajor, kMaxContacts, kState>;
  using Contacts = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxContacts, 1>;
  using ContactSquare =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxContacts, kMaxContacts>;
  using SupportsByOscillators = Eigen::Matrix<double, Eigen::Dynamic, kOscillators, Eigen::RowMajor>;
  static constexpr int kSeries = is_fixed ? kTerms * 2 * N : Eigen::Dynamic;
  // Taylor polynomials of all components of the state, one below the other; and as columns.
  using Series = Eigen::Matrix<double, kSeries, 1>;
  using SeriesByState = Eigen::Matrix<double, kSeries, kState>;
  using SeriesByOscillators = Eigen::Matrix<double, kSeries, kOscillators>;
  using SeriesByContacts =
      Eigen::Matrix<double, kSeries, Eigen::Dynamic, Eigen::ColMajor, kSeries, kMaxContacts>;
  using StatePolynomials = Eigen::Matrix<double, kTerms, kState>;
  using OscillatorPolynomials = Eigen::Matrix<double, kTerms, kOscillators>;
};

}  // namespace frahm::periodic
