// A process that is asked to stop while METIS, which has a handler of its own for that, is at work.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "backends/posix/process.hpp"
#include "backends/suitesparse/ordering.hpp"

namespace traceraft {
namespace {

// Five points of a square grid.
fem::SparsityPattern grid(int side) {
  fem::SparsityPattern pattern;
  pattern.row_begin.push_back(0);
  for (int i = 0; i < side * side; ++i) {
    const int x = i % side, y = i / side;
    if (y > 0) pattern.column.push_back(i - side);
    if (x > 0) pattern.column.push_back(i - 1);
    pattern.diagonal.push_back(pattern.entries());
    pattern.column.push_back(i);
    if (x + 1 < side) pattern.column.push_back(i + 1);
    if (y + 1 < side) pattern.column.push_back(i + side);
    pattern.row_begin.push_back(pattern.entries());
  }
  return pattern;
}

constexpr int kStopped = 5;

[[noreturn]] void order_until_stopped(int ready) {
  posix::end_on_stop_signals(kStopped, "");
  const fem::SparsityPattern pattern = grid(100);
  std::thread worker([&] {
    for (;;) suitesparse::metis_ordering(pattern);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  if (write(ready, "r", 1) != 1) _exit(1);
  worker.join();
  _exit(1);
}

TEST(StopSignals, EndTheProcessAsAgreedWhileMetisIsAtWork) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    int channel[2];
    ASSERT_EQ(pipe(channel), 0);
    const pid_t child = fork();
    if (child == 0) order_until_stopped(channel[1]);
    close(channel[1]);
    char letter = 0;
    ASSERT_EQ(read(channel[0], &letter, 1), 1);
    close(channel[0]);
    kill(child, SIGTERM);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
    ASSERT_EQ(WEXITSTATUS(status), kStopped);
  }
}

}  // namespace
}  // namespace traceraft
