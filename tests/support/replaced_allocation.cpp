#include "tests/support/replaced_allocation.hpp"

// Not inlined: gcc would take the free() for a mistake (-Wmismatched-new-delete).
[[gnu::noinline]] void* operator new(std::size_t size) {
  return yuragi::test::allocate(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return yuragi::test::allocate(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
