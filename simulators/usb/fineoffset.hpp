#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "simulators/usb/hid_model.hpp"

namespace yuragi::simulators::usb {

/// How long a console's records are, bytes.
enum class FineOffsetRecord : std::uint8_t { kWh1080 = 16, kWh3080 = 20 };

/// A Fine Offset WH1080 (or WH3080) console: its memory, which the host reads and the console writes. A block that is
/// read while the console writes to it is half old, half new; the real console may even lock up then, so the model
/// counts how often that happens.
class FineOffset final : public HidModel {
 public:
  FineOffset(FineOffsetRecord record, const HidModelOptions& options);

  /// Blocks that were read within 3 s (real ones) of the console's writing.
  int reads_near_writing() const noexcept { return reads_near_writing_; }
  int blocks_read() const noexcept { return blocks_read_; }

 protected:
  void play() override;
  bool take_output(std::span<const std::uint8_t> report) override;

 private:
  /// A byte that will be in the memory from some time on.
  struct Write {
    double at_s;
    std::uint16_t address;
    std::uint8_t value;
  };

  void write(std::uint16_t address, std::span<const std::uint8_t> bytes);
  void update_current_record();
  void end_minute();
  void reply(std::uint16_t address);
  void queue_block(Bytes block);
  std::vector<std::uint8_t> measured() const;

  std::uint16_t record_size_;
  std::vector<std::uint8_t> memory_;
  std::deque<Write> writes_;  ///< that are under way
  std::uint16_t position_;    ///< of the current record
  std::uint16_t records_ = 1;
  std::uint8_t delay_min_ = 0;  ///< since the last record was kept
  double next_update_s_;
  double next_minute_s_;
  double last_write_s_ = -1e9;
  double gust_m_s_ = 0.0;  ///< since the last update
  bool has_begun_ = false;
  int reads_near_writing_ = 0;
  int blocks_read_ = 0;
};

}  // namespace yuragi::simulators::usb
