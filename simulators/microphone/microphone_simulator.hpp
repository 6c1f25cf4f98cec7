#pragma once

#include <memory>
#include <string>

#include "simulators/core/simulator.hpp"
#include "simulators/microphone/microphone_sound.hpp"

namespace yuragi::simulators::microphone {

/// The outputs of the sound, in real time. Raw 32-bit floats, native byte order, frame after frame.
struct Outputs {
  std::string socket;  ///< a Unix stream socket to listen on, any number of clients; empty: none
  std::string pipe;    ///< a named pipe that another program reads (PulseAudio's module-pipe-source); empty: none
};

/// Simulated microphones. A client too slow for the sound loses some of it, in whole frames. While unplugged, the
/// socket and its name do not exist and the named pipe is closed; both return.
class Simulator final : public core::Simulator {
 public:
  /// Listens at once. Throws std::runtime_error if that fails.
  Simulator(const Options& options, Outputs outputs, core::MeasuredWind wind);
  ~Simulator() override;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The faults that microphones can play.
std::span<const core::FaultKind> microphone_faults();

}  // namespace yuragi::simulators::microphone
