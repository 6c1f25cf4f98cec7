#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

// GObject's own types, so that its headers stay in the source files.
// NOLINTBEGIN(bugprone-reserved-identifier): the names are GObject's
struct _UMockdevIoctlBase;
struct _UMockdevIoctlClient;
struct _UMockdevIoctlData;
// NOLINTEND(bugprone-reserved-identifier)

namespace yuragi::simulators::usb {

/// Memory of the program under test, as umockdev gives access to it: a copy, which is written back to the program with
/// the reply to the call that it belongs to. Copies of this refer to the same memory. Thread-safe: no.
class ProgramMemory {
 public:
  ProgramMemory() = default;
  /// Takes ownership of the reference.
  explicit ProgramMemory(_UMockdevIoctlData* data);

  explicit operator bool() const noexcept { return data_ != nullptr; }
  std::span<const std::uint8_t> bytes() const;
  /// Its address in the program, which the program's pointers hold.
  std::uintptr_t address() const;
  /// The memory that the pointer at `offset` points to; empty for a null pointer, for no bytes, or a program that has
  /// ended.
  ProgramMemory pointed_to(std::size_t offset, std::size_t size) const;
  /// Writes as many bytes as fit.
  void write(std::size_t offset, std::span<const std::uint8_t> bytes) const;
  /// Makes the pointer at `offset`, which was not followed before, point to that memory.
  void point_to(std::size_t offset, const ProgramMemory& target) const;

  template <class T>
  void write_value(const T& value) const {
    write(0, {reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }

 private:
  std::shared_ptr<_UMockdevIoctlData> data_;
};

enum class ProgramCallKind : std::uint8_t { kIoctl, kRead, kWrite };

/// A system call on a device node in which the program under test waits. It is completed once; on destruction with EIO,
/// if it was not. Movable. Thread-safe: no.
class ProgramCall {
 public:
  /// Takes ownership of the reference.
  ProgramCall(ProgramCallKind kind, _UMockdevIoctlClient* client);
  ProgramCall(ProgramCall&& other) noexcept;
  ProgramCall& operator=(ProgramCall&& other) noexcept;
  ProgramCall(const ProgramCall&) = delete;
  ProgramCall& operator=(const ProgramCall&) = delete;
  ~ProgramCall();

  ProgramCallKind kind() const noexcept { return kind_; }
  /// Of an ioctl.
  unsigned long request() const;
  /// For an ioctl its argument, which is a pointer or a number; for a read or a write the buffer.
  ProgramMemory argument() const;

  void reply(long result) { finish(result, 0); }
  void fail(int error) { finish(-1, error); }

 private:
  void finish(long result, int error);

  ProgramCallKind kind_;
  _UMockdevIoctlClient* client_;
};

/// The calls on one device node, handed from umockdev's thread to the simulator's. Thread-safe: between those two.
class ProgramCallQueue {
 public:
  ProgramCallQueue();
  ~ProgramCallQueue();
  ProgramCallQueue(const ProgramCallQueue&) = delete;
  ProgramCallQueue& operator=(const ProgramCallQueue&) = delete;

  /// Readable while calls wait.
  int descriptor() const noexcept;
  /// The next call, if one waits.
  std::optional<ProgramCall> take();
  /// How often the node is open at the moment.
  int opens() const noexcept;

  /// The handler for umockdev to attach to the node; a new reference, owned by the caller.
  _UMockdevIoctlBase* make_handler() const;

  struct State;

 private:
  std::shared_ptr<State> state_;
};

}  // namespace yuragi::simulators::usb
