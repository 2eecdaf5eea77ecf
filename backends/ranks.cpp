#include "backends/ranks.hpp"

#include <cstdlib>

#include "kernel/core/error.hpp"
#ifdef TRACERAFT_WITH_MPI
#include "backends/mpi/mpi_communicator.hpp"
#endif
#ifdef TRACERAFT_WITH_TRILINOS
#include "backends/trilinos/runtime.hpp"
#endif

namespace traceraft::backends {
namespace {

// mpirun of Open MPI, MPICH and Intel MPI, and srun say so in the environment.
bool started_together() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(variable)) return true;
  return false;
}

// How many were started; 0 if nobody says so.
int started_ranks() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* size = std::getenv(variable)) return std::atoi(size);
  return 0;
}

}  // namespace

#ifdef TRACERAFT_WITH_MPI

namespace {
// How long a rank that fails waits for the others to fail, too.
constexpr double kPatience = 2;
std::unique_ptr<mpi::MpiSession> session;
}  // namespace

RankSession::RankSession() {
  // A process alone, which starts MPI for Trilinos later, needs no daemon of Open MPI beside it.
  if (!started_together()) {
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    return;
  }
  session = std::make_unique<mpi::MpiSession>();
  if (const int started = started_ranks(); started > 1 && mpi::mpi_world()->size() == 1) {
    session.reset();
    throw InputError(
        "several processes were started that do not find each other: use the mpirun of the MPI "
        "that this program was built with");
  }
}
RankSession::~RankSession() {
#ifdef TRACERAFT_WITH_TRILINOS
  trilinos::finish_trilinos();
#endif
  session.reset();
}

bool RankSession::there_is() {
  return session != nullptr;
}
bool RankSession::all_fail() {
  return !session || session->all_fail(kPatience);
}
void RankSession::abort(int exit_code) {
  if (session) session->abort(exit_code);
  std::exit(exit_code);
}

std::shared_ptr<const Communicator> world() {
  if (session) return mpi::mpi_world();
  return std::make_shared<SerialCommunicator>();
}

#else

RankSession::RankSession() {
  if (started_together() && started_ranks() != 1)
    throw InputError(
        "this program was built without MPI and runs as one process only; install the Debian "
        "packages libopenmpi-dev and openmpi-bin, and build it again");
}
RankSession::~RankSession() = default;

bool RankSession::there_is() {
  return started_together();
}
bool RankSession::all_fail() {
  return true;
}
void RankSession::abort(int exit_code) {
  std::exit(exit_code);
}

std::shared_ptr<const Communicator> world() {
  return std::make_shared<SerialCommunicator>();
}

#endif

}  // namespace traceraft::backends
