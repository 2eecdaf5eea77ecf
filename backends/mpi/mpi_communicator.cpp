#include "backends/mpi/mpi_communicator.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "kernel/core/stopwatch.hpp"

namespace traceraft::mpi {
namespace {

// Messages of one exchange do not mix with ghosts.
enum Tag { kGhosts = 1, kExchange = 2 };

MPI_Comm farewell = MPI_COMM_NULL;  // apart from all other messages

double reduced(double local, MPI_Op operation) {
  double result = 0;
  MPI_Allreduce(&local, &result, 1, MPI_DOUBLE, operation, MPI_COMM_WORLD);
  return result;
}

// One request per piece of a long message.
template <class Start>
void for_each_piece(std::size_t bytes, std::size_t longest, const Start& start) {
  for (std::size_t at = 0; at < bytes; at += longest)
    start(at, static_cast<int>(std::min(longest, bytes - at)));
}

class MpiCommunicator final : public Communicator {
 public:
  explicit MpiCommunicator(std::size_t longest_message) : longest_message_(longest_message) {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  double sum(double local) const override { return reduced(local, MPI_SUM); }
  double max(double local) const override { return reduced(local, MPI_MAX); }
  double min(double local) const override { return reduced(local, MPI_MIN); }
  void max(VecRef values) const override {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                  MPI_COMM_WORLD);
  }

  void update_ghosts(const HaloPlan& plan, VecRef field) const override {
    std::vector<std::vector<double>> sent;
    std::vector<MPI_Request> requests;
    double* ghost = field.data() + field.size();
    for (const auto& neighbour : plan.neighbours) ghost -= neighbour.receive_count;
    for (const auto& neighbour : plan.neighbours) {
      MPI_Irecv(ghost, neighbour.receive_count, MPI_DOUBLE, neighbour.rank, kGhosts, MPI_COMM_WORLD,
                &requests.emplace_back());
      ghost += neighbour.receive_count;
    }
    for (const auto& neighbour : plan.neighbours) {
      std::vector<double>& buffer = sent.emplace_back();
      for (const int i : neighbour.send) buffer.push_back(field[i]);
      MPI_Isend(buffer.data(), static_cast<int>(buffer.size()), MPI_DOUBLE, neighbour.rank, kGhosts,
                MPI_COMM_WORLD, &requests.emplace_back());
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  }

  std::vector<std::string> exchange(std::vector<std::string> to) const override {
    std::vector<std::uint64_t> lengths, expected(to.size());
    for (const std::string& message : to) lengths.push_back(message.size());
    MPI_Alltoall(lengths.data(), 1, MPI_UINT64_T, expected.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    std::vector<std::string> from;
    for (const std::uint64_t length : expected) from.emplace_back(length, '\0');
    std::vector<MPI_Request> requests;
    for (int rank = 0; rank < size_; ++rank) {
      if (rank == rank_) continue;
      for_each_piece(from[rank].size(), longest_message_, [&](std::size_t at, int count) {
        MPI_Irecv(from[rank].data() + at, count, MPI_BYTE, rank, kExchange, MPI_COMM_WORLD,
                  &requests.emplace_back());
      });
      for_each_piece(to[rank].size(), longest_message_, [&](std::size_t at, int count) {
        MPI_Isend(to[rank].data() + at, count, MPI_BYTE, rank, kExchange, MPI_COMM_WORLD,
                  &requests.emplace_back());
      });
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    from[rank_] = std::move(to[rank_]);
    return from;
  }

 private:
  std::size_t longest_message_;
  int rank_ = 0, size_ = 1;
};

}  // namespace

std::shared_ptr<const Communicator> mpi_world(std::size_t longest_message) {
  return std::make_shared<MpiCommunicator>(longest_message);
}

MpiSession::MpiSession() {
  // The two solves of a step may run on two threads, and take turns at the library that calls MPI.
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    throw std::runtime_error("MPI does not start");
  MPI_Comm_dup(MPI_COMM_WORLD, &farewell);
}

MpiSession::~MpiSession() {
  MPI_Comm_free(&farewell);
  MPI_Finalize();
}

bool MpiSession::all_fail(double seconds) const {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(farewell, &request);
  const Stopwatch watch;
  for (int here = 0; watch.seconds() < seconds;
       std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    MPI_Test(&request, &here, MPI_STATUS_IGNORE);
    if (here) return true;
  }
  return false;
}

void MpiSession::abort(int exit_code) const {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();  // MPI_Abort does not return
}

}  // namespace traceraft::mpi
