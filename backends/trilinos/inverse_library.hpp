// The inverses that Teko builds preconditioners from, by name.
#pragma once

#include <Teko_InverseLibrary.hpp>
#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

namespace traceraft::trilinos {

// Names of whole preconditioners: our own and Teko's for comparison.
inline const std::vector<std::string> kTekoPreconditioners = {"two-solve", "gauss-seidel",
                                                              "block-lu"};
// Names of inverses of one matrix.
inline const std::vector<std::string> kTekoInverses = {"muelu", "muelu-ilu", "ifpack2", "direct"};

// A library with all of these; the preconditioners use `inverse` for the matrices that are hard.
// `own` is added to it, or replaces what has the same name.
// What Teko prints goes to teko_complaints() instead.
// Compiled without optimisation, because registering MueLu takes long otherwise and runs once.
Teuchos::RCP<Teko::InverseLibrary> make_inverse_library(const std::string& inverse,
                                                        const Teuchos::ParameterList& own);

// The text that Teko has written since the last call, which is where it tells what went wrong.
std::string teko_complaints();

}  // namespace traceraft::trilinos
