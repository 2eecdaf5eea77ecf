#include <suitesparse/klu.h>

#include <string>

#include "backends/suitesparse/sparse_lu.hpp"

namespace traceraft::suitesparse {
namespace {

class KluLu final : public SparseLu {
 public:
  KluLu() {
    klu_defaults(&common_);
    common_.btf = 0;  // the matrix is irreducible
  }
  ~KluLu() override {
    klu_free_symbolic(&symbolic_, &common_);
    klu_free_numeric(&numeric_, &common_);
  }
  KluLu(const KluLu&) = delete;
  KluLu& operator=(const KluLu&) = delete;

  Status factorise(AssembledSystem& system, const std::vector<int>& order) override {
    klu_free_numeric(&numeric_, &common_);
    if (!symbolic_) {
      std::vector<int> permutation = order;
      symbolic_ = klu_analyze_given(system.size(), system.begin(), system.index(),
                                    permutation.data(), permutation.data(), &common_);
    }
    if (symbolic_)
      numeric_ = klu_factor(system.begin(), system.index(), system.values(), symbolic_, &common_);
    if (numeric_ && common_.status == KLU_OK) return {};
    klu_free_numeric(&numeric_, &common_);
    return Status::retry(common_.status == KLU_SINGULAR
                             ? "KLU: the matrix is singular"
                             : "KLU: error " + std::to_string(common_.status));
  }

  Status solve(AssembledSystem& system, const Vec& right, Vec& solution) override {
    solution = right;
    // The arrays hold rows: KLU sees the transpose.
    if (!klu_tsolve(symbolic_, numeric_, system.size(), 1, solution.data(), &common_))
      return Status::retry("KLU: error " + std::to_string(common_.status));
    return {};
  }

 private:
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseLu> make_klu_lu() {
  return std::make_unique<KluLu>();
}

}  // namespace traceraft::suitesparse
