#pragma once

#include <Eigen/Core>
#include <complex>

// The kernels of Eigen's products and triangular solves of run-time sized matrices, which every file that
// writes A * B would compile again, a second each: files with precompiled headers find them declared here as
// compiled once, in kernels_once.cpp; no file needs to include this. None of them is ever inlined, so that
// nothing becomes slower.
namespace Eigen::internal {

template <class Scalar, int Order>
using FrahmRead = const_blas_data_mapper<Scalar, Index, Order>;
template <class Scalar>
using FrahmWrite = blas_data_mapper<Scalar, Index, ColMajor, Unaligned, 1>;

// C += alpha A B, of packed panels, and the packing of each factor by its storage order.
#define FRAHM_PRODUCT(ONCE, Scalar)                                                                         \
  ONCE template struct gebp_kernel<Scalar, Scalar, Index, FrahmWrite<Scalar>,                               \
                                   gebp_traits<Scalar, Scalar>::mr, gebp_traits<Scalar, Scalar>::nr, false, \
                                   false>;                                                                  \
  ONCE template struct gemm_pack_lhs<                                                                       \
      Scalar, Index, FrahmRead<Scalar, ColMajor>, gebp_traits<Scalar, Scalar>::mr,                          \
      gebp_traits<Scalar, Scalar>::LhsProgress, gebp_traits<Scalar, Scalar>::LhsPacket4Packing, ColMajor>;  \
  ONCE template struct gemm_pack_lhs<                                                                       \
      Scalar, Index, FrahmRead<Scalar, RowMajor>, gebp_traits<Scalar, Scalar>::mr,                          \
      gebp_traits<Scalar, Scalar>::LhsProgress, gebp_traits<Scalar, Scalar>::LhsPacket4Packing, RowMajor>;  \
  ONCE template struct gemm_pack_rhs<Scalar, Index, FrahmRead<Scalar, ColMajor>,                            \
                                     gebp_traits<Scalar, Scalar>::nr, ColMajor>;                            \
  ONCE template struct gemm_pack_rhs<Scalar, Index, FrahmRead<Scalar, RowMajor>,                            \
                                     gebp_traits<Scalar, Scalar>::nr, RowMajor>;                            \
  ONCE template struct gemm_pack_rhs<Scalar, Index, FrahmWrite<Scalar>, gebp_traits<Scalar, Scalar>::nr,    \
                                     ColMajor, false, true>;                                                \
  ONCE template struct general_matrix_matrix_product<Index, Scalar, ColMajor, false, Scalar, ColMajor,      \
                                                     false, ColMajor, 1>;                                   \
  ONCE template struct general_matrix_matrix_product<Index, Scalar, ColMajor, false, Scalar, RowMajor,      \
                                                     false, ColMajor, 1>;                                   \
  ONCE template struct general_matrix_matrix_product<Index, Scalar, RowMajor, false, Scalar, ColMajor,      \
                                                     false, ColMajor, 1>;                                   \
  ONCE template struct general_matrix_matrix_product<Index, Scalar, RowMajor, false, Scalar, RowMajor,      \
                                                     false, ColMajor, 1>;

// y += alpha A x
#define FRAHM_PRODUCT_WITH_VECTOR(ONCE, Scalar, Order, Entries, Version)                                    \
  ONCE template struct general_matrix_vector_product<Index, Scalar, FrahmRead<Scalar, Order>, Order, false, \
                                                     Scalar, FrahmRead<Scalar, Entries>, false, Version>;

// X of T X = B (OnTheLeft) and X T = B, T triangular.
#define FRAHM_TRIANGULAR_SOLVE(ONCE, Scalar, Side, Mode, Order) \
  ONCE template struct triangular_solve_matrix<Scalar, Index, Side, Mode, false, Order, ColMajor, 1>;

// C += alpha T B, T triangular: of blocks of Householder's reflections.
#define FRAHM_TRIANGULAR_PRODUCT(ONCE, Mode, Order, OrderOfOther)                                \
  ONCE template struct product_triangular_matrix_matrix<double, Index, Mode, true, Order, false, \
                                                        OrderOfOther, false, ColMajor, 1, Specialized>;

#define FRAHM_KERNELS(ONCE)                                            \
  FRAHM_PRODUCT(ONCE, double)                                          \
  FRAHM_PRODUCT(ONCE, std::complex<double>)                            \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, ColMajor, ColMajor, 0)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, ColMajor, RowMajor, 0)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, RowMajor, ColMajor, 0)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, RowMajor, RowMajor, 0)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, ColMajor, RowMajor, 1)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, ColMajor, ColMajor, 1)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, RowMajor, ColMajor, 1)       \
  FRAHM_PRODUCT_WITH_VECTOR(ONCE, double, RowMajor, RowMajor, 1)       \
  FRAHM_TRIANGULAR_SOLVE(ONCE, double, OnTheLeft, Lower, ColMajor)     \
  FRAHM_TRIANGULAR_SOLVE(ONCE, double, OnTheLeft, Upper, ColMajor)     \
  FRAHM_TRIANGULAR_SOLVE(ONCE, double, OnTheLeft, Upper, RowMajor)     \
  FRAHM_TRIANGULAR_SOLVE(ONCE, double, OnTheLeft, UnitLower, ColMajor) \
  FRAHM_TRIANGULAR_SOLVE(ONCE, double, OnTheRight, Upper, RowMajor)    \
  FRAHM_TRIANGULAR_PRODUCT(ONCE, Lower, ColMajor, ColMajor)            \
  FRAHM_TRIANGULAR_PRODUCT(ONCE, Upper, RowMajor, ColMajor)            \
  FRAHM_TRIANGULAR_PRODUCT(ONCE, UnitUpper, RowMajor, ColMajor)        \
  FRAHM_TRIANGULAR_PRODUCT(ONCE, UnitLower, ColMajor, ColMajor)

FRAHM_KERNELS(extern)

}  // namespace Eigen::internal
