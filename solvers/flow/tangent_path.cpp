#include "solvers/flow/tangent_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/flow/polynomial.hpp"
#include "solvers/flow/side_by_side.hpp"

namespace frahm::periodic {
namespace {

// Columns move side by side in a register of x86-64-v3, or two of less. A step times the fastest rate is at
// most kMostRate: the series over it adds e^kMostRate of rounding at most. It ends where its terms fall below
// kEnd.
struct Exact {
  using Real = double;
  static constexpr int kColumns = 4;
  using Number = double __attribute__((vector_size(kColumns * sizeof(double))));
  static constexpr double kMostRate = 3.0, kEnd = 1e-15;
};
struct Rough {
  using Real = float;
  static constexpr int kColumns = 8;
  using Number = float __attribute__((vector_size(kColumns * sizeof(float))));
  static constexpr double kMostRate = 6.0, kEnd = 1e-3;
};

// The number of terms after which a Taylor series in steps of this rate has ended: rate^k / k! < end.
int terms_of(double rate, double end) {
  int terms = 1;
  for (double term = 1.0; term > end; ++terms) term *= rate / terms;
  return terms;
}

template <class Precision>
class Columns {
 public:
  using Real = typename Precision::Real;
  using Number = typename Precision::Number;

  explicit Columns(const SystemOf<Real>& system)
      : system_(system),
        masses_(static_cast<std::size_t>(system.masses())),
        x_(2 * masses_ + static_cast<std::size_t>(system.internal_forces())),
        term_(x_),
        next_(x_),
        work_(keep_work(system)) {}

  void read(const Eigen::MatrixXd& columns, Eigen::Index first) {
    const Eigen::Index count = std::min<Eigen::Index>(Precision::kColumns, columns.cols() - first);
    std::fill(x_.begin(), x_.end(), Number{});
    for (Eigen::Index c = 0; c < count; ++c) {
      for (std::size_t i = 0; i < x_.size(); ++i)
        x_[i][c] = static_cast<Real>(columns(static_cast<Eigen::Index>(i), first + c));
    }
  }
  void write(Eigen::MatrixXd& columns, Eigen::Index first) const {
    const Eigen::Index count = std::min<Eigen::Index>(Precision::kColumns, columns.cols() - first);
    for (Eigen::Index c = 0; c < count; ++c) {
      for (std::size_t i = 0; i < x_.size(); ++i)
        columns(static_cast<Eigen::Index>(i), first + c) = static_cast<double>(x_[i][c]);
    }
  }

  void begin(const HeldOf<Real>& held, const std::vector<int>& stopped) {
    keep_numbers(system_, held, work_.data(), x_.data() + masses_);
    stop(stopped);
  }
  void pass(const TangentPath::Stretch& stretch, const HeldOf<Real>& held) {
    if (stretch.steps > 0.0) {
      const double pieces = std::max(1.0, std::ceil(stretch.steps * kStepRate / Precision::kMostRate));
      const double h = stretch.steps / pieces;
      const int terms = terms_of(h * kStepRate, Precision::kEnd);
      for (double piece = 0.0; piece < pieces; piece += 1.0) take_long_step(held, h, terms);
    }
    jump(stretch.jumps);
    stop(stretch.stopped);
  }

 private:
  // x(h) = sum_k h^k x_k,  x = (q, v, s)
  void take_long_step(const HeldOf<Real>& held, double h, int terms) {
    Number *x = x_.data(), *term = term_.data(), *next = next_.data();
    const std::size_t n = masses_, size = x_.size();
    std::copy_n(x, size, term);
    for (int k = 1; k < terms; ++k) {
      pull_numbers(system_, held, term, term + n, term + 2 * n, work_.data(), next, next + n);
      const auto share = static_cast<Real>(h / k);
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += term[i] = share * term[n + i];
        x[n + i] += term[n + i] = share * next[i];
      }
      for (std::size_t i = 2 * n; i < size; ++i) x[i] += term[i] = share * next[i - n];
    }
  }

  void jump(const std::vector<TangentPath::Jump>& jumps) {
    Number* v = x_.data() + masses_;
    slip_.resize(jumps.size());
    for (std::size_t k = 0; k < jumps.size(); ++k)
      slip_[k] = jumps[k].contact < 0
                     ? form_of(jumps[k].by)
                     : row_times(system_.directions, static_cast<std::size_t>(jumps[k].contact), v);
    for (std::size_t k = 0; k < jumps.size(); ++k) {
      const double* change = jumps[k].change.data();
      for (std::size_t i = 0; i < masses_; ++i) v[i] += static_cast<Real>(change[i]) * slip_[k];
    }
  }

  Number form_of(const Eigen::VectorXd& by) const {
    Number sum{};
    for (std::size_t i = 0; i < x_.size(); ++i)
      sum += static_cast<Real>(by[static_cast<Eigen::Index>(i)]) * x_[i];
    return sum;
  }

  void stop(const std::vector<int>& internal) {
    for (const int i : internal) x_[2 * masses_ + static_cast<std::size_t>(i)] = Number{};
  }

  const SystemOf<Real>& system_;
  std::size_t masses_;
  std::vector<Number> x_, term_, next_, work_, slip_;
};

template <class Precision>
void follow_columns(const TangentPath& path, const SystemOf<typename Precision::Real>& system,
                    std::span<const HeldOf<typename Precision::Real>* const> held, Eigen::MatrixXd& columns) {
  Columns<Precision> block(system);
  for (Eigen::Index first = 0; first < columns.cols(); first += Precision::kColumns) {
    block.read(columns, first);
    block.begin(*held.front(), path.stopped);
    for (std::size_t i = 0; i < path.stretches.size(); ++i) block.pass(path.stretches[i], *held[i + 1]);
    block.write(columns, first);
  }
}

}  // namespace

void follow(const TangentPath& path, const SparseSystem& system, std::span<const HeldContacts* const> held,
            Eigen::MatrixXd& columns) {
  follow_columns<Exact>(path, system, held, columns);
}

void follow_roughly(const TangentPath& path, const SystemOf<float>& system,
                    std::span<const HeldContacts* const> held, Eigen::MatrixXd& columns) {
  std::map<const HeldContacts*, HeldOf<float>> rough;
  for (const HeldContacts* contacts : held) {
    if (!rough.contains(contacts)) rough.emplace(contacts, in_single_precision(*contacts));
  }
  std::vector<const HeldOf<float>*> rough_held;
  for (const HeldContacts* contacts : held) rough_held.push_back(&rough.at(contacts));
  follow_columns<Rough>(path, system, rough_held, columns);
}

}  // namespace frahm::periodic
