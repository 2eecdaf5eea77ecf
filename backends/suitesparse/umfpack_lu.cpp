#include <suitesparse/umfpack.h>

#include <string>

#include "backends/suitesparse/sparse_lu.hpp"

namespace traceraft::suitesparse {
namespace {

class UmfpackLu final : public SparseLu {
 public:
  UmfpackLu() {
    umfpack_di_defaults(control_);
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control_[UMFPACK_IRSTEP] = 0;  // who solves refines where it is needed
  }
  ~UmfpackLu() override {
    umfpack_di_free_symbolic(&symbolic_);
    umfpack_di_free_numeric(&numeric_);
  }
  UmfpackLu(const UmfpackLu&) = delete;
  UmfpackLu& operator=(const UmfpackLu&) = delete;

  Status factorise(AssembledSystem& system, const std::vector<int>& order) override {
    umfpack_di_free_numeric(&numeric_);
    double info[UMFPACK_INFO];
    int flag = UMFPACK_OK;
    if (!symbolic_)
      flag = umfpack_di_qsymbolic(system.size(), system.size(), system.begin(), system.index(),
                                  system.values(), order.data(), &symbolic_, control_, info);
    if (flag == UMFPACK_OK)
      flag = umfpack_di_numeric(system.begin(), system.index(), system.values(), symbolic_,
                                &numeric_, control_, info);
    if (flag == UMFPACK_OK) return {};
    umfpack_di_free_numeric(&numeric_);
    return Status::retry(flag == UMFPACK_WARNING_singular_matrix
                             ? "UMFPACK: the matrix is singular"
                             : "UMFPACK: error " + std::to_string(flag));
  }

  Status solve(AssembledSystem& system, const Vec& right, Vec& solution) override {
    solution.resize(right.size());
    double info[UMFPACK_INFO];
    // The arrays hold rows: UMFPACK sees the transpose and solves with its transpose.
    const int flag = umfpack_di_solve(UMFPACK_At, system.begin(), system.index(), system.values(),
                                      solution.data(), right.data(), numeric_, control_, info);
    if (flag != UMFPACK_OK) return Status::retry("UMFPACK: error " + std::to_string(flag));
    return {};
  }

 private:
  double control_[UMFPACK_CONTROL];
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseLu> make_umfpack_lu() {
  return std::make_unique<UmfpackLu>();
}

}  // namespace traceraft::suitesparse
