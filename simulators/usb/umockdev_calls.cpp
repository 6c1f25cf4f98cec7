#include "simulators/usb/umockdev_calls.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <deque>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/eventfd.h>
#include <umockdev.h>
#include <unistd.h>

namespace yuragi::simulators::usb {

struct ProgramCallQueue::State {
  std::mutex mutex;
  std::deque<ProgramCall> calls;
  std::atomic<int> opens = 0;
  int descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);

  State() {
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  ~State() { close(descriptor); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

namespace {

using SharedState = std::shared_ptr<ProgramCallQueue::State>;

constexpr const char* kStateKey = "yuragi-calls";

ProgramCallQueue::State& state_of(UMockdevIoctlBase* handler) {
  return **static_cast<SharedState*>(g_object_get_data(reinterpret_cast<GObject*>(handler), kStateKey));
}

// Umockdev calls these on a thread of its own. A call is kept until the simulator's thread has completed it.
gboolean keep_call(UMockdevIoctlBase* handler, UMockdevIoctlClient* client, ProgramCallKind kind) {
  ProgramCallQueue::State& state = state_of(handler);
  g_object_ref(client);
  const std::lock_guard lock(state.mutex);
  state.calls.emplace_back(kind, client);
  eventfd_write(state.descriptor, 1);
  return 1;
}
gboolean keep_ioctl(UMockdevIoctlBase* handler, UMockdevIoctlClient* client) {
  return keep_call(handler, client, ProgramCallKind::kIoctl);
}
gboolean keep_read(UMockdevIoctlBase* handler, UMockdevIoctlClient* client) {
  return keep_call(handler, client, ProgramCallKind::kRead);
}
gboolean keep_write(UMockdevIoctlBase* handler, UMockdevIoctlClient* client) {
  return keep_call(handler, client, ProgramCallKind::kWrite);
}
void count_open(UMockdevIoctlBase* handler, UMockdevIoctlClient* /*client*/) {
  ++state_of(handler).opens;
}
void count_close(UMockdevIoctlBase* handler, UMockdevIoctlClient* /*client*/) {
  --state_of(handler).opens;
}

/// Our subclass of UMockdevIoctlBase, registered once.
GType handler_type() {
  static const GType type = [] {
    GTypeInfo info{};
    info.class_size = sizeof(UMockdevIoctlBaseClass);
    info.instance_size = sizeof(UMockdevIoctlBase);
    info.class_init = [](gpointer own_class, gpointer /*data*/) {
      auto* const base = static_cast<UMockdevIoctlBaseClass*>(own_class);
      base->handle_ioctl = keep_ioctl;
      base->handle_read = keep_read;
      base->handle_write = keep_write;
      base->client_connected = count_open;
      base->client_vanished = count_close;
    };
    return g_type_register_static(umockdev_ioctl_base_get_type(), "YuragiProgramCalls", &info, GTypeFlags{});
  }();
  return type;
}

}  // namespace

ProgramMemory::ProgramMemory(_UMockdevIoctlData* data)
    : data_(data, [](UMockdevIoctlData* held) {
        if (held != nullptr) g_object_unref(held);
      }) {}

std::span<const std::uint8_t> ProgramMemory::bytes() const {
  if (!data_) return {};
  return {data_->data, static_cast<std::size_t>(data_->data_len)};
}

std::uintptr_t ProgramMemory::address() const {
  return data_ ? data_->client_addr : 0;
}

ProgramMemory ProgramMemory::pointed_to(std::size_t offset, std::size_t size) const {
  if (!data_ || size == 0) return {};
  GError* error = nullptr;
  UMockdevIoctlData* const target = umockdev_ioctl_data_resolve(data_.get(), offset, size, &error);
  if (error != nullptr) g_error_free(error);
  return target == nullptr ? ProgramMemory() : ProgramMemory(target);
}

void ProgramMemory::write(std::size_t offset, std::span<const std::uint8_t> bytes) const {
  const std::size_t room = this->bytes().size();
  if (offset >= room) return;
  bytes = bytes.first(std::min(bytes.size(), room - offset));
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  if (!copy.empty()) umockdev_ioctl_data_update(data_.get(), offset, copy.data(), static_cast<gint>(copy.size()));
}

void ProgramMemory::point_to(std::size_t offset, const ProgramMemory& target) const {
  if (data_ && target) umockdev_ioctl_data_set_ptr(data_.get(), offset, target.data_.get());
}

ProgramCall::ProgramCall(ProgramCallKind kind, _UMockdevIoctlClient* client) : kind_(kind), client_(client) {}

ProgramCall::ProgramCall(ProgramCall&& other) noexcept
    : kind_(other.kind_), client_(std::exchange(other.client_, nullptr)) {}

ProgramCall& ProgramCall::operator=(ProgramCall&& other) noexcept {
  std::swap(kind_, other.kind_);
  std::swap(client_, other.client_);
  return *this;
}

ProgramCall::~ProgramCall() {
  if (client_ != nullptr) fail(EIO);
}

unsigned long ProgramCall::request() const {
  return umockdev_ioctl_client_get_request(client_);
}

ProgramMemory ProgramCall::argument() const {
  UMockdevIoctlData* const data = umockdev_ioctl_client_get_arg(client_);
  return ProgramMemory(data == nullptr ? nullptr : static_cast<UMockdevIoctlData*>(g_object_ref(data)));
}

void ProgramCall::finish(long result, int error) {
  UMockdevIoctlClient* const client = std::exchange(client_, nullptr);
  if (client == nullptr) return;
  umockdev_ioctl_client_complete(client, result, error);
  g_object_unref(client);
}

ProgramCallQueue::ProgramCallQueue() : state_(std::make_shared<State>()) {}

ProgramCallQueue::~ProgramCallQueue() = default;

int ProgramCallQueue::descriptor() const noexcept {
  return state_->descriptor;
}

int ProgramCallQueue::opens() const noexcept {
  return state_->opens;
}

std::optional<ProgramCall> ProgramCallQueue::take() {
  const std::lock_guard lock(state_->mutex);
  if (state_->calls.empty()) {
    eventfd_t ignored = 0;
    eventfd_read(state_->descriptor, &ignored);
    return std::nullopt;
  }
  std::optional<ProgramCall> call(std::move(state_->calls.front()));
  state_->calls.pop_front();
  return call;
}

_UMockdevIoctlBase* ProgramCallQueue::make_handler() const {
  auto* const handler = static_cast<UMockdevIoctlBase*>(g_object_new(handler_type(), nullptr));
  g_object_set_data_full(
      reinterpret_cast<GObject*>(handler), kStateKey, std::make_unique<SharedState>(state_).release(),
      [](gpointer held) { const std::unique_ptr<SharedState> gone(static_cast<SharedState*>(held)); });
  return handler;
}

}  // namespace yuragi::simulators::usb
