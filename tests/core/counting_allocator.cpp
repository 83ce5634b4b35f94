#include "tests/core/counting_allocator.h"

#include <malloc.h>

#include <cstdlib>
#include <new>

namespace ctpm::testing {

std::atomic<long> allocations{0}, live_bytes{0};

}  // namespace ctpm::testing

namespace {

using namespace ctpm::testing;

void* allocate(std::size_t size) noexcept {
  ++allocations;
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory != nullptr) live_bytes += long(malloc_usable_size(memory));
  return memory;
}

void* allocate_or_throw(std::size_t size) {
  if (void* memory = allocate(size)) return memory;
  throw std::bad_alloc();
}

void release(void* memory) {
  live_bytes -= long(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return allocate_or_throw(size); }
void* operator new[](std::size_t size) { return allocate_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
