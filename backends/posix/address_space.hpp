// A limit of the address space (ulimit -v) that libraries could not start within.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>

namespace traceraft::posix {

// OpenBLAS maps a buffer as soon as it is loaded, before main, and waits forever where it gets
// none. An entry of the executable's .preinit_array is called before that. Nothing but system calls
// is safe there. Exits with `code` if a mapping of that size is refused.
template <int code>
void require_address_space(int, char**, char**) {
  constexpr std::size_t kBytes = std::size_t{160} << 20;
  void* const trial = mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial != MAP_FAILED) {
    munmap(trial, kBytes);
    return;
  }
  constexpr char kLine[] =
      "traceraft: the limit of the address space (ulimit -v) is too low for the libraries to "
      "start; "
      "raise it to 1 GB or more\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLine, sizeof kLine - 1);
  _exit(code);
}

}  // namespace traceraft::posix
