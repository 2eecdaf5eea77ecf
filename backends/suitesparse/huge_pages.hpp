// Memory in pages of 2 MiB where the system has them: a factor is read from end to end in every
// solve, and with pages of 4 KiB a good part of that time goes into finding them.
#pragma once

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace traceraft {

template <class T>
struct HugePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21;

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T), whole = (bytes + kPage - 1) / kPage * kPage;
    void* memory = bytes < kPage ? std::malloc(bytes) : std::aligned_alloc(kPage, whole);
    if (!memory) throw std::bad_alloc();
    // A wish: without it the memory is the same, in smaller pages.
    if (bytes >= kPage) (void)madvise(memory, whole, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  friend bool operator==(const HugePages&, const HugePages&) { return true; }
  friend bool operator!=(const HugePages&, const HugePages&) { return false; }
};

}  // namespace traceraft
