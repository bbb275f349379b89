#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "solvers/smooth/integrator.hpp"

namespace frahm::smooth {
namespace {

using Vector = Eigen::Map<Eigen::VectorXd>;

Vector view(N_Vector vector) {
  return {N_VGetArrayPointer(vector), N_VGetLength(vector)};
}

Eigen::Map<Eigen::MatrixXd> view(SUNMatrix matrix) {
  return {SUNDenseMatrix_Data(matrix), SUNDenseMatrix_Rows(matrix), SUNDenseMatrix_Columns(matrix)};
}

void require(int result, const char* call) {
  if (result < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(result));
}

void keep_quiet(int, const char*, const char*, char*, void*) {}

// The flag's meaning for a reason.
const char* failure_text(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_WORK:
      return "the smooth motion takes too many steps a period";
    case CV_ERR_FAILURE:
    case CV_CONV_FAILURE:
      return "the smooth motion cannot be followed to the tolerance: its steps become too small";
    case CV_TOO_MUCH_ACC:
      return "the smooth motion cannot be followed to the tolerance: it is below rounding";
    default:
      return "the smooth motion cannot be integrated";
  }
}

// For a step with its sensitivities, and without them [s], of N states: measured from 2 to 400.
double step_work(double N) {
  return 1.5e-6 + 1e-6 * N + 0.12e-6 * N * N + 1.5e-9 * N * N * N;
}
double step_work_alone(double N) {
  return 0.6e-6 + 0.25e-6 * N + 0.02e-6 * N * N + 0.1e-9 * N * N * N;
}

}  // namespace

class Integrator::Cvodes {
 public:
  // work: of its passages; must outlive it.
  Cvodes(Equation& equation, const IntegratorOptions& options, periodic::SearchWork& work);
  ~Cvodes();

  void pass(const Eigen::VectorXd& start, double t, double duration, const Eigen::VectorXd& scale,
            Passage& passage);
  bool follow(Eigen::VectorXd& state, double t, double duration, const Eigen::VectorXd& scale);

 private:
  static int rates(realtype t, N_Vector z, N_Vector dz, void* self);
  static int jacobian(realtype t, N_Vector z, N_Vector dz, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector);
  static int sensitivity_rates(int count, realtype t, N_Vector z, N_Vector dz, N_Vector* s, N_Vector* ds,
                               void* self, N_Vector, N_Vector);
  void begin(const Eigen::VectorXd& start, double t, const Eigen::VectorXd& scale);
  void record_step(Passage& passage);

  Equation& equation_;
  IntegratorOptions options_;
  periodic::SearchWork& work_;
  int size_;
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  N_Vector state_ = nullptr, tolerance_ = nullptr, derivative_ = nullptr;
  N_Vector *sensitivity_ = nullptr, *sensitivity_tolerance_ = nullptr;
  Eigen::MatrixXd J_;
};

Integrator::Cvodes::Cvodes(Equation& equation, const IntegratorOptions& options, periodic::SearchWork& work)
    : equation_(equation),
      options_(options),
      work_(work),
      size_(static_cast<int>(equation.size())),
      J_(equation.size(), equation.size()) {
  require(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
  state_ = N_VNew_Serial(size_, context_);
  tolerance_ = N_VNew_Serial(size_, context_);
  derivative_ = N_VNew_Serial(size_, context_);
  sensitivity_ = N_VCloneVectorArray(size_, state_);
  sensitivity_tolerance_ = N_VCloneVectorArray(size_, state_);
  matrix_ = SUNDenseMatrix(size_, size_, context_);
  linear_ = SUNLinSol_Dense(state_, matrix_, context_);
  memory_ = CVodeCreate(CV_BDF, context_);
  if (!memory_ || !linear_ || !sensitivity_ || !sensitivity_tolerance_) throw std::bad_alloc();
  N_VConst(0.0, state_);
  N_VConst(1.0, tolerance_);
  for (int k = 0; k < size_; ++k) {
    N_VConst(0.0, sensitivity_[k]);
    N_VConst(1.0, sensitivity_tolerance_[k]);
  }
  require(CVodeSetErrHandlerFn(memory_, keep_quiet, nullptr), "CVodeSetErrHandlerFn");
  require(CVodeInit(memory_, rates, 0.0, state_), "CVodeInit");
  require(CVodeSetUserData(memory_, this), "CVodeSetUserData");
  require(CVodeSVtolerances(memory_, options_.tolerance, tolerance_), "CVodeSVtolerances");
  require(CVodeSetLinearSolver(memory_, linear_, matrix_), "CVodeSetLinearSolver");
  require(CVodeSetJacFn(memory_, jacobian), "CVodeSetJacFn");
  require(CVodeSetMaxNumSteps(memory_, options_.most_steps), "CVodeSetMaxNumSteps");
  require(CVodeSensInit(memory_, size_, CV_STAGGERED, sensitivity_rates, sensitivity_), "CVodeSensInit");
  require(CVodeSensSVtolerances(memory_, options_.sensitivity_tolerance, sensitivity_tolerance_),
          "CVodeSensSVtolerances");
  require(CVodeSetSensErrCon(memory_, SUNTRUE), "CVodeSetSensErrCon");
}

Integrator::Cvodes::~Cvodes() {
  CVodeFree(&memory_);
  if (linear_) SUNLinSolFree(linear_);
  if (matrix_) SUNMatDestroy(matrix_);
  N_VDestroyVectorArray(sensitivity_tolerance_, size_);
  N_VDestroyVectorArray(sensitivity_, size_);
  for (N_Vector vector : {state_, tolerance_, derivative_}) N_VDestroy(vector);
  SUNContext_Free(&context_);
}

int Integrator::Cvodes::rates(realtype t, N_Vector z, N_Vector dz, void* self) {
  static_cast<Cvodes*>(self)->equation_.rates(t, view(z), view(dz));
  return view(dz).allFinite() ? 0 : 1;
}

int Integrator::Cvodes::jacobian(realtype t, N_Vector z, N_Vector, SUNMatrix J, void* self, N_Vector,
                                 N_Vector, N_Vector) {
  static_cast<Cvodes*>(self)->equation_.jacobian(t, view(z), view(J));
  return 0;
}

// s_k' = J s_k
int Integrator::Cvodes::sensitivity_rates(int count, realtype t, N_Vector z, N_Vector, N_Vector* s,
                                          N_Vector* ds, void* self, N_Vector, N_Vector) {
  auto& cvodes = *static_cast<Cvodes*>(self);
  cvodes.equation_.jacobian(t, view(z), cvodes.J_);
  for (int k = 0; k < count; ++k) view(ds[k]).noalias() = cvodes.J_ * view(s[k]);
  return 0;
}

// A column of the tangent is d z / d z_k: it counts in units of scale_i / scale_k.
void Integrator::Cvodes::begin(const Eigen::VectorXd& start, double t, const Eigen::VectorXd& scale) {
  view(state_) = start;
  view(tolerance_) = options_.tolerance * scale;
  for (int k = 0; k < size_; ++k) {
    view(sensitivity_[k]).setUnit(k);
    view(sensitivity_tolerance_[k]) = options_.sensitivity_tolerance / scale[k] * scale;
  }
  require(CVodeReInit(memory_, t, state_), "CVodeReInit");
  require(CVodeSVtolerances(memory_, options_.tolerance, tolerance_), "CVodeSVtolerances");
  require(CVodeSensReInit(memory_, CV_STAGGERED, sensitivity_), "CVodeSensReInit");
  require(CVodeSensSVtolerances(memory_, options_.sensitivity_tolerance, sensitivity_tolerance_),
          "CVodeSensSVtolerances");
}

void Integrator::Cvodes::pass(const Eigen::VectorXd& start, double t, double duration,
                              const Eigen::VectorXd& scale, Passage& passage) {
  begin(start, t, scale);
  passage.trajectory.clear(size_);
  passage.steps = 0;
  passage.local_errors = 0.0;
  passage.failure = nullptr;
  const double stop = t + duration, of_step = step_work(size_);
  require(CVodeSetStopTime(memory_, stop), "CVodeSetStopTime");
  for (int flag = CV_SUCCESS; flag != CV_TSTOP_RETURN;) {
    realtype reached = t;
    flag = CVode(memory_, stop, state_, &reached, CV_ONE_STEP);
    if (flag < 0 || passage.steps >= options_.most_steps) {
      passage.failure = failure_text(flag < 0 ? flag : CV_TOO_MUCH_WORK);
      return;
    }
    work_.add(of_step);
    if (work_.is_over()) {
      passage.failure = periodic::kSearchIsLong;
      return;
    }
    ++passage.steps;
    record_step(passage);
  }
  passage.end = view(state_);
  realtype at = 0.0;
  require(CVodeGetSens(memory_, &at, sensitivity_), "CVodeGetSens");
  passage.tangent.resize(size_, size_);
  for (int k = 0; k < size_; ++k) passage.tangent.col(k) = view(sensitivity_[k]);
}

bool Integrator::Cvodes::follow(Eigen::VectorXd& state, double t, double duration,
                                const Eigen::VectorXd& scale) {
  if (work_.is_over()) return false;
  view(state_) = state;
  view(tolerance_) = options_.follow_tolerance * scale;
  require(CVodeReInit(memory_, t, state_), "CVodeReInit");
  require(CVodeSVtolerances(memory_, options_.follow_tolerance, tolerance_), "CVodeSVtolerances");
  require(CVodeSensToggleOff(memory_), "CVodeSensToggleOff");
  require(CVodeSetStopTime(memory_, t + duration), "CVodeSetStopTime");
  realtype reached = t;
  const int flag = CVode(memory_, t + duration, state_, &reached, CV_NORMAL);
  long steps = 0;
  require(CVodeGetNumSteps(memory_, &steps), "CVodeGetNumSteps");
  work_.add(static_cast<double>(steps) * step_work_alone(size_));
  if (flag < 0) return false;
  state = view(state_);
  return true;
}

// The step's estimated error, and the Taylor coefficients of the interpolating polynomial about its end,
// z^(k)/k!.
void Integrator::Cvodes::record_step(Passage& passage) {
  realtype end = 0.0, length = 0.0;
  int order = 0;
  require(CVodeGetCurrentTime(memory_, &end), "CVodeGetCurrentTime");
  require(CVodeGetLastStep(memory_, &length), "CVodeGetLastStep");
  require(CVodeGetLastOrder(memory_, &order), "CVodeGetLastOrder");
  auto coefficients = passage.trajectory.add(end - length, end);
  double factorial = 1.0;
  for (int k = 0; k <= order; ++k) {
    require(CVodeGetDky(memory_, end, k, derivative_), "CVodeGetDky");
    coefficients.col(k) = view(derivative_) / factorial;
    factorial *= k + 1;
  }
  require(CVodeGetEstLocalErrors(memory_, derivative_), "CVodeGetEstLocalErrors");
  passage.local_errors += equation_.energy_norm(view(derivative_));
}

Integrator::Integrator(Equation& equation, const IntegratorOptions& options)
    : cvodes_(std::make_unique<Cvodes>(equation, options, work_)) {}
Integrator::~Integrator() = default;

void Integrator::pass(const Eigen::VectorXd& start, double t, double duration, const Eigen::VectorXd& scale,
                      Passage& passage) {
  cvodes_->pass(start, t, duration, scale, passage);
}

bool Integrator::follow(Eigen::VectorXd& state, double t, double duration, const Eigen::VectorXd& scale) {
  return cvodes_->follow(state, t, duration, scale);
}

}  // namespace frahm::smooth
