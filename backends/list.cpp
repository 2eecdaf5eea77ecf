#include "backends/list.hpp"

#include "backends/euler/euler.hpp"
#include "backends/rosenbrock/rosenbrock.hpp"
#include "backends/suitesparse/blas.hpp"
#include "backends/suitesparse/direct_solver.hpp"
#include "backends/suitesparse/supernodal_solver.hpp"
#include "backends/sundials/ida.hpp"
#include "backends/sundials/ida_settings.hpp"
#include "backends/sundials/spfgmr.hpp"
#ifdef TRACERAFT_WITH_TRILINOS
#include "backends/trilinos/teko_solver.hpp"
#endif
#include "kernel/core/error.hpp"
#include "kernel/linear/block_solver.hpp"

namespace traceraft::backends {
namespace {

void require_one_rank(const char* name, const fem::SurfaceSpace& space) {
  if (space.communicator->size() > 1)
    throw InputError(std::string(name) +
                     " works on one rank only; on several ranks, choose the linear solver teko");
}

linear::LinearSolverFactory block(const fem::SurfaceSpace& space, const WordOptions&) {
  require_one_rank("block", space);
  // A mesh that is not uniform is one of many in a run.
  const auto ordering =
      space.mesh.uniform() ? suitesparse::Ordering::dissection : suitesparse::Ordering::quick;
  return [spd = suitesparse::supernodal_factory(space.pattern, ordering), size = 2 * space.nodes(),
          team = space.team](int lanes) {
    return linear::make_block_solver(
        spd, [size] { return sundials::make_spfgmr(size); }, team, lanes);
  };
}

linear::LinearSolverFactory direct(const fem::SurfaceSpace& space, const WordOptions&) {
  require_one_rank("direct", space);
  return [pattern = space.pattern](int lanes) {
    return suitesparse::make_direct_solver("direct", suitesparse::make_umfpack_lu, pattern, lanes);
  };
}

// KLU works on columns one by one, without dense blocks: on larger meshes it takes many times as
// long as UMFPACK.
linear::LinearSolverFactory klu(const fem::SurfaceSpace& space, const WordOptions&) {
  require_one_rank("klu", space);
  constexpr int kMost = 25000;
  const int unknowns = 2 * space.nodes();
  if (unknowns > kMost)
    throw InputError("klu is for small systems, at most " + std::to_string(kMost) +
                     " unknowns, and this mesh has " + std::to_string(unknowns) +
                     "; choose block (the fastest), direct, or a coarser mesh");
  return [pattern = space.pattern](int lanes) {
    return suitesparse::make_direct_solver("klu", suitesparse::make_klu_lu, pattern, lanes);
  };
}

#ifdef TRACERAFT_WITH_TRILINOS
constexpr bool kWithTrilinos = true;
linear::LinearSolverFactory teko(const fem::SurfaceSpace& space, const WordOptions& options) {
  suitesparse::use_one_blas_thread();  // Tpetra's sums and LAPACK go there, too
  return trilinos::make_teko_solver(space.pattern, options);
}
#else
constexpr bool kWithTrilinos = false;
linear::LinearSolverFactory teko(const fem::SurfaceSpace&, const WordOptions&) {
  throw InputError(
      "teko was not built in: it needs MPI and Trilinos; install the Debian packages "
      "trilinos-all-dev, libopenmpi-dev and openmpi-bin, and build again");
}
#endif

}  // namespace

const NamedList<LinearSolverEntry>& linear_solvers() {
  static const std::vector<LinearSolverEntry> entries = {
      {"block", "SUNDIALS GMRES, two-solve preconditioner, Cholesky factors of 16 bits", "direct",
       block},
      {"direct", "UMFPACK factors of the whole system at every solve", "", direct},
      {"klu", "KLU factors of the whole system at every solve, for small meshes", "", klu},
      {"teko",
       "Trilinos: Belos with block preconditioners of Teko, on any number of ranks",
       "",
       teko,
       {text_parameter(
            "preconditioner", "two-solve",
            "block preconditioner: two-solve, gauss-seidel, block-lu, or a name from the file"),
        text_parameter("inverse", "muelu",
                       "inverse of a block: muelu, muelu-ilu (stronger and more expensive), "
                       "ifpack2, direct (one rank), or a name from the file"),
        text_parameter("method", "fgmres", "Krylov method: fgmres, gmres, gcrodr or bicgstab"),
        text_parameter(
            "renewal", "worn",
            "when a new preconditioner is computed: worn (when iterations grow) or always"),
        text_parameter("parameters", "", "Teuchos XML file with sublists Inverse Library and Belos",
                       ParameterKind::file)},
       kWithTrilinos,
       true},
  };
  static const NamedList<LinearSolverEntry> list("linear solver", entries);
  return list;
}

const NamedList<IntegratorEntry>& integrators() {
  static const std::vector<IntegratorEntry> entries = {
      {"euler", "stabilised Euler/BDF2 pair with Gomez-Hughes steps", 5e-3, euler::make_euler},
      {"ida", "SUNDIALS IDA: BDF of variable order, Newton with the exact Jacobian", 1e-3,
       sundials::make_ida, sundials::ida_parameters()},
      {"rosenbrock", "ROS34PW2: linearly implicit, order 3, no Newton iteration", 1e-3,
       rosenbrock::make_rosenbrock},
  };
  static const NamedList<IntegratorEntry> list("integrator", entries);
  return list;
}

std::vector<std::string> built_linear_solvers() {
  std::vector<std::string> names;
  for (const LinearSolverEntry& entry : linear_solvers())
    if (entry.built) names.push_back(entry.name);
  return names;
}

linear::LinearSolverChoice choose_linear_solver(const std::string& name,
                                                const fem::SurfaceSpace& space,
                                                const WordOptions& options) {
  const LinearSolverEntry& entry = linear_solvers().find(name);
  linear::LinearSolverChoice choice{entry.make(space, options), nullptr};
  if (!entry.fallback.empty())
    choice.fallback = linear_solvers().find(entry.fallback).make(space, {});
  return choice;
}

}  // namespace traceraft::backends
