#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace yuragi::fft {

/// A real Fourier transform over a periodic line (dims 1), square (2) or cube (3) of `size` samples an edge, with the
/// buffers that it works on. The one wrapper of FFTW3 (Frigo and Johnson 2005, "The design and implementation of
/// FFTW3"), in double precision.
///
/// Layout: samples() has size^dims numbers, x running fastest. The spectrum of real numbers is Hermitian,
/// F(-k) = conj(F(k)), so spectrum() holds the half with kx = 0 .. size / 2, kx running fastest: size^(dims-1) rows of
/// row_modes(). On the other axes index i stands for the wave number i, or i - size above size / 2. In the columns
/// kx = 0 and kx = size / 2 both a mode and its mirror image are stored; the caller keeps them conjugate.
/// Neither direction is normalised: forward() then inverse() multiplies by size^dims.
///
/// Bits: plans are made with FFTW_ESTIMATE on buffers of FFTW's own alignment, so one machine always computes the same
/// bits; machines of other instruction sets agree to about 1e-15.
/// Thread-safe: one object is one thread's; different objects are independent (FFTW's planner is not, so construction
/// and destruction hold a lock). Realtime-safe: forward() and inverse() are; construction and destruction are not.
class RealFft {
 public:
  /// Throws std::invalid_argument if dims is not 1 to 3, size is 0 or above 2^22, or there are more than 2^31 samples;
  /// std::bad_alloc without memory.
  RealFft(int dims, std::size_t size);
  ~RealFft();
  RealFft(RealFft&&) noexcept;
  RealFft& operator=(RealFft&&) noexcept;

  /// Both buffers belong to this object and live as long as it does; zero at first.
  std::span<double> samples() noexcept;
  std::span<std::complex<double>> spectrum() noexcept;

  int dims() const noexcept;
  std::size_t size() const noexcept;
  std::size_t row_modes() const noexcept { return size() / 2 + 1; }

  /// spectrum() from samples(), with exp(-i k x); samples() keep their values.
  void forward() noexcept;

  /// samples() from spectrum(), with exp(+i k x); spectrum() is destroyed.
  void inverse() noexcept;

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace yuragi::fft
