#include "cvode.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tribofit {

namespace {

Cvode::State state_of(N_Vector y) {
  Cvode::State state;
  std::copy_n(N_VGetArrayPointer(y), Cvode::kSize, state.begin());
  return state;
}

// What CVODE calls; user is the Problem.

int rates(realtype t, N_Vector y, N_Vector dy, void* user) {
  Cvode::State rate;
  static_cast<const Cvode::Problem*>(user)->rates(t, state_of(y), rate);
  std::copy(rate.begin(), rate.end(), N_VGetArrayPointer(dy));
  return 0;
}

int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector, N_Vector) {
  Cvode::Jacobian values;
  static_cast<const Cvode::Problem*>(user)->jacobian(t, state_of(y), values);
  for (std::size_t column = 0; column < Cvode::kSize; ++column) {
    realtype* into = SUNDenseMatrix_Column(matrix, static_cast<sunindextype>(column));
    for (std::size_t row = 0; row < Cvode::kSize; ++row) into[row] = values[row][column];
  }
  return 0;
}

/// CVODE would print; its words are kept instead.
void keep_message(int, const char*, const char*, char* message, void* into) {
  *static_cast<std::string*>(into) = message;
}

}  // namespace

struct Cvode::Handles {
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* memory = nullptr;

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    if (memory != nullptr) CVodeFree(&memory);
    if (solver != nullptr) SUNLinSolFree(solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }
};

Cvode::Cvode(Problem problem, double t, const State& y, const Options& options)
    : problem_(std::move(problem)), time_(t), state_(y), handles_(std::make_unique<Handles>()) {
  Handles& h = *handles_;
  bool good = SUNContext_Create(nullptr, &h.context) == 0;
  if (good) {
    h.y = N_VNew_Serial(kSize, h.context);
    h.matrix = SUNDenseMatrix(kSize, kSize, h.context);
    h.memory = CVodeCreate(CV_BDF, h.context);
  }
  good = good && h.y != nullptr && h.matrix != nullptr && h.memory != nullptr;
  if (good) {
    std::copy(y.begin(), y.end(), N_VGetArrayPointer(h.y));
    h.solver = SUNLinSol_Dense(h.y, h.matrix, h.context);
  }
  good = good && h.solver != nullptr && CVodeSetErrHandlerFn(h.memory, keep_message, &failure_) == CV_SUCCESS &&
         CVodeInit(h.memory, rates, t, h.y) == CV_SUCCESS &&
         CVodeSStolerances(h.memory, options.relative_tolerance, options.absolute_tolerance) == CV_SUCCESS &&
         CVodeSetUserData(h.memory, &problem_) == CV_SUCCESS &&
         CVodeSetLinearSolver(h.memory, h.solver, h.matrix) == CV_SUCCESS &&
         CVodeSetJacFn(h.memory, jacobian) == CV_SUCCESS && CVodeSetMaxStep(h.memory, options.max_step) == CV_SUCCESS;
  if (!good) throw std::runtime_error("CVODE cannot be set up" + (failure_.empty() ? "" : ": " + failure_));
}

Cvode::~Cvode() = default;

bool Cvode::step(double until) {
  Handles& h = *handles_;
  realtype reached = time_;
  if (CVodeSetStopTime(h.memory, until) < 0) return false;
  const int status = CVode(h.memory, until, h.y, &reached, CV_ONE_STEP);
  time_ = reached;
  state_ = state_of(h.y);
  return status >= 0;
}

Cvode::State Cvode::at(double t) const {
  const Handles& h = *handles_;
  CVodeGetDky(h.memory, t, 0, h.y);
  return state_of(h.y);
}

}  // namespace tribofit
