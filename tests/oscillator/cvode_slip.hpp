#pragma once

#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace tribofit {

/// An initial value problem solved by SUNDIALS CVODE with root finding: written apart from the library's own
/// integrator, for comparison.
class CvodeSolver {
 public:
  using Rhs = std::function<void(double t, const double* y, double* dy)>;
  using Root = std::function<double(double t, const double* y)>;

  CvodeSolver(int method, std::size_t size, Rhs rhs, Root root, double tolerance, double absolute)
      : rhs_(std::move(rhs)), root_(std::move(root)) {
    SUNContext_Create(nullptr, &context_);
    y_ = N_VNew_Serial(static_cast<sunindextype>(size), context_);
    N_VConst(0.0, y_);
    matrix_ = SUNDenseMatrix(static_cast<sunindextype>(size), static_cast<sunindextype>(size), context_);
    solver_ = SUNLinSol_Dense(y_, matrix_, context_);
    memory_ = CVodeCreate(method, context_);
    CVodeInit(memory_, evaluate, 0.0, y_);
    CVodeSStolerances(memory_, tolerance, absolute);
    CVodeSetUserData(memory_, this);
    CVodeSetLinearSolver(memory_, solver_, matrix_);
    CVodeSetMaxNumSteps(memory_, 10000000);
    CVodeRootInit(memory_, 1, evaluate_root);
    int falling = -1;
    CVodeSetRootDirection(memory_, &falling);
    CVodeSetNoInactiveRootWarn(memory_);
  }
  ~CvodeSolver() {
    CVodeFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  CvodeSolver(const CvodeSolver&) = delete;
  CvodeSolver& operator=(const CvodeSolver&) = delete;

  double* start() { return N_VGetArrayPointer(y_); }
  void restart(double t) { CVodeReInit(memory_, t, y_); }
  /// Goes to `until` or the next falling root, whichever comes first; true at a root. `t` is where it stopped.
  bool advance(double until, double& t) {
    const int status = CVode(memory_, until, y_, &t, CV_NORMAL);
    EXPECT_GE(status, 0) << "CVODE failed at t = " << t;
    return status == CV_ROOT_RETURN;
  }

 private:
  static int evaluate(realtype t, N_Vector y, N_Vector dy, void* self) {
    static_cast<CvodeSolver*>(self)->rhs_(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  }
  static int evaluate_root(realtype t, N_Vector y, realtype* g, void* self) {
    *g = static_cast<CvodeSolver*>(self)->root_(t, N_VGetArrayPointer(y));
    return 0;
  }

  Rhs rhs_;
  Root root_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace tribofit
