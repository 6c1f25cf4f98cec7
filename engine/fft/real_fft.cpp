#include "engine/fft/real_fft.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <stdexcept>

#include <fftw3.h>

namespace yuragi::fft {
namespace {

constexpr std::size_t kMaxSize = std::size_t{1} << 22U;
constexpr std::size_t kMaxSamples = std::size_t{1} << 31U;

/// FFTW's planner has global state: creating and destroying plans needs a lock. Executing them does not.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct FreeBuffer {
  void operator()(void* buffer) const noexcept { fftw_free(buffer); }
};

struct DestroyPlan {
  void operator()(fftw_plan plan) const noexcept {
    const std::scoped_lock lock(planner_mutex());
    fftw_destroy_plan(plan);
  }
};

template <class T>
using Buffer = std::unique_ptr<T[], FreeBuffer>;
using Plan = std::unique_ptr<fftw_plan_s, DestroyPlan>;

/// A zeroed buffer of FFTW's alignment.
template <class T>
Buffer<T> make_buffer(std::size_t count) {
  auto* const memory = static_cast<T*>(fftw_malloc(count * sizeof(T)));
  if (memory == nullptr) throw std::bad_alloc();
  std::uninitialized_fill_n(memory, count, T{});
  return Buffer<T>(memory);
}

}  // namespace

struct RealFft::Plans {
  int dims;
  std::size_t size;
  std::size_t sample_count;
  std::size_t mode_count;
  Buffer<double> samples;
  Buffer<std::complex<double>> spectrum;
  Plan forward;
  Plan inverse;
};

RealFft::RealFft(int dims, std::size_t size) {
  if (dims < 1 || dims > 3 || size < 1 || size > kMaxSize) {
    throw std::invalid_argument("a transform must have 1 to 3 dimensions of 1 to 2^22 samples each");
  }
  std::size_t rows = 1;
  for (int axis = 1; axis < dims; ++axis) rows *= size;
  if (rows > kMaxSamples / size) throw std::invalid_argument("a transform must have at most 2^31 samples");

  const std::size_t mode_count = rows * (size / 2 + 1);
  plans_ = std::make_unique<Plans>(Plans{dims, size, rows * size, mode_count, make_buffer<double>(rows * size),
                                         make_buffer<std::complex<double>>(mode_count), nullptr, nullptr});

  // FFTW_ESTIMATE chooses by rule, not by timing, and leaves the buffers alone. C++ guarantees that a complex<double>
  // is laid out as an fftw_complex.
  std::array<int, 3> shape{};
  shape.fill(static_cast<int>(size));
  auto* const modes = reinterpret_cast<fftw_complex*>(plans_->spectrum.get());
  {
    const std::scoped_lock lock(planner_mutex());
    plans_->forward.reset(
        fftw_plan_dft_r2c(dims, shape.data(), plans_->samples.get(), modes, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT));
    plans_->inverse.reset(
        fftw_plan_dft_c2r(dims, shape.data(), modes, plans_->samples.get(), FFTW_ESTIMATE | FFTW_DESTROY_INPUT));
  }
  if (!plans_->forward || !plans_->inverse) throw std::bad_alloc();
}

RealFft::~RealFft() = default;
RealFft::RealFft(RealFft&&) noexcept = default;
RealFft& RealFft::operator=(RealFft&&) noexcept = default;

std::span<double> RealFft::samples() noexcept {
  return {plans_->samples.get(), plans_->sample_count};
}

std::span<std::complex<double>> RealFft::spectrum() noexcept {
  return {plans_->spectrum.get(), plans_->mode_count};
}

int RealFft::dims() const noexcept {
  return plans_->dims;
}
std::size_t RealFft::size() const noexcept {
  return plans_->size;
}

void RealFft::forward() noexcept {
  fftw_execute(plans_->forward.get());
}
void RealFft::inverse() noexcept {
  fftw_execute(plans_->inverse.get());
}

}  // namespace yuragi::fft
