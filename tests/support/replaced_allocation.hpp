#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

// For one source of a test program that decides what memory there is: it defines allocate(), by which every operator
// new of the program allocates. What it returns is freed by std::free().

namespace yuragi::test {

/// Throws std::bad_alloc where there is to be no memory.
void* allocate(std::size_t size);

/// What allocate() returns where nothing is wrong.
inline void* allocate_as_usual(std::size_t size) {
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace yuragi::test
