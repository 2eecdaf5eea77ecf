#include "backends/trilinos/inverse_library.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Stratimikos_MueLuHelpers.hpp>
#include <Teko_StratimikosFactory.hpp>

#include "backends/trilinos/two_solve_factory.hpp"

namespace traceraft {
namespace {

using Teuchos::ParameterList;

// One V-cycle. The stabilisation acts like a fourth-order operator where the mobility vanishes,
// which point smoothers hardly damp: on the finest mesh an incomplete factorisation smooths.
void add_muelu(ParameterList& library) {
  ParameterList& list = library.sublist("muelu");
  list.set("Type", "MueLu");
  list.set("verbosity", "none");
  list.set("max levels", 10);
  list.set("coarse: max size", 500);
  list.set("smoother: type", "RELAXATION");
  list.sublist("smoother: params")
      .set("relaxation: type", "Symmetric Gauss-Seidel")
      .set("relaxation: sweeps", 2);
  ParameterList& finest = list.sublist("level 0");
  finest.set("smoother: type", "RILUK");
  finest.sublist("smoother: params")
      .set("fact: iluk level-of-fill", 2)
      .set("fact: relative threshold", 1.05);
  // MueLu's own choice, KLU2 of Amesos2, is wrong on more than one rank in Trilinos 13.2.
  list.set("coarse: type", "CHEBYSHEV");
  list.sublist("coarse: params")
      .set("chebyshev: degree", 12)
      .set("chebyshev: ratio eigenvalue", 30.0);
}

void add_ifpack2(ParameterList& library) {
  ParameterList& list = library.sublist("ifpack2");
  list.set("Type", "Ifpack2");
  list.set("Prec Type", "RILUK");
  list.sublist("Ifpack2 Settings")
      .set("fact: iluk level-of-fill", 2)
      .set("fact: relative threshold", 1.05);
}

void add_direct(ParameterList& library) {
  ParameterList& list = library.sublist("direct");
  list.set("Type", "Amesos2");
  list.set("Solver Type", "KLU2");
}

void add_preconditioners(ParameterList& library, const std::string& inverse) {
  ParameterList& own = library.sublist("two-solve");
  own.set("Type", TwoSolveFactory::kName);
  own.set("First Inverse Type", inverse);
  own.set("Second Inverse Type", inverse);
  ParameterList& seidel = library.sublist("gauss-seidel");
  seidel.set("Type", "Block Gauss-Seidel");
  seidel.set("Inverse Type", inverse);
  seidel.set("Use Upper Triangle", false);
  ParameterList& lu = library.sublist("block-lu");
  lu.set("Type", "Block LU2x2");
  lu.set("Use LDU", true);
  lu.set("Strategy Name", "Diagonal Strategy");
  lu.sublist("Strategy Settings")
      .set("Inverse A00 Type", inverse)
      .set("Inverse Schur Type", inverse)
      .set("Diagonal Type", "AbsRowSum");
}

}  // namespace

Teuchos::RCP<Teko::InverseLibrary> make_inverse_library(const std::string& inverse,
                                                        const ParameterList& own) {
  const auto stratimikos = Teuchos::rcp(new Stratimikos::DefaultLinearSolverBuilder);
  Stratimikos::enableMueLu<>(*stratimikos);
  Teko::addToStratimikosBuilder(stratimikos);
  TwoSolveFactory::register_by_name();
  ParameterList library("Inverse Library");
  add_muelu(library);
  add_ifpack2(library);
  add_direct(library);
  add_preconditioners(library, inverse);
  library.setParameters(own);
  return Teko::InverseLibrary::buildFromParameterList(library, stratimikos);
}

}  // namespace traceraft
