// An ALSA plugin for tests: a sound card whose microphones are a simulator's. It reads raw 32-bit floats from the Unix
// socket that `yuragi-sim microphone --listen` serves, at the pace at which they come; when that socket is closed, the
// card is gone. Everything above it is real: alsa-lib, PortAudio, the driver.
//
//   pcm_type.windsim { lib "/.../libasound_module_pcm_windsim.so" }
//   pcm.windmic { type windsim path "/tmp/mic.sock" channels 2 rate 48000 }
//
// Source of the interface: alsa-lib 1.2.8, pcm_ioplug.h and its documentation, "External PCM plugins (I/O plugin)".
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace {

class Card {
 public:
  Card(int socket, unsigned channels, unsigned rate) : socket_(socket), channels_(channels), rate_(rate) {}
  ~Card() { close(socket_); }
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  int open(snd_pcm_t** pcm, const char* name, snd_pcm_stream_t stream, int mode) {
    static const snd_pcm_ioplug_callback_t callbacks = make_callbacks();
    io_.version = SND_PCM_IOPLUG_VERSION;
    io_.name = "simulated microphones";
    io_.poll_fd = socket_;
    io_.poll_events = POLLIN;
    io_.mmap_rw = 0;
    io_.callback = &callbacks;
    io_.private_data = this;
    const int error = snd_pcm_ioplug_create(&io_, name, stream, mode);
    if (error < 0) return error;

    const std::array<unsigned, 2> access = {SND_PCM_ACCESS_RW_INTERLEAVED, SND_PCM_ACCESS_MMAP_INTERLEAVED};
    const std::array<unsigned, 1> format = {SND_PCM_FORMAT_FLOAT_LE};
    const auto frame_bytes = static_cast<unsigned>(channels_ * sizeof(float));
    snd_pcm_ioplug_set_param_list(&io_, SND_PCM_IOPLUG_HW_ACCESS, access.size(), access.data());
    snd_pcm_ioplug_set_param_list(&io_, SND_PCM_IOPLUG_HW_FORMAT, format.size(), format.data());
    snd_pcm_ioplug_set_param_minmax(&io_, SND_PCM_IOPLUG_HW_CHANNELS, channels_, channels_);
    snd_pcm_ioplug_set_param_minmax(&io_, SND_PCM_IOPLUG_HW_RATE, rate_, rate_);
    snd_pcm_ioplug_set_param_minmax(&io_, SND_PCM_IOPLUG_HW_PERIOD_BYTES, 64 * frame_bytes, 4096 * frame_bytes);
    snd_pcm_ioplug_set_param_minmax(&io_, SND_PCM_IOPLUG_HW_PERIODS, 2, 16);
    *pcm = io_.pcm;
    return 0;
  }

 private:
  static Card& of(snd_pcm_ioplug_t* io) { return *static_cast<Card*>(io->private_data); }

  static snd_pcm_ioplug_callback_t make_callbacks() {
    snd_pcm_ioplug_callback_t callbacks{};
    callbacks.prepare = [](snd_pcm_ioplug_t* io) {
      of(io).prepare(io->buffer_size);
      return 0;
    };
    callbacks.start = [](snd_pcm_ioplug_t* io) {
      of(io).skip_old_sound();
      return 0;
    };
    callbacks.stop = [](snd_pcm_ioplug_t*) { return 0; };
    callbacks.pointer = [](snd_pcm_ioplug_t* io) -> snd_pcm_sframes_t {
      Card& card = of(io);
      card.receive();
      if (card.is_gone_) return -ENODEV;
      return static_cast<snd_pcm_sframes_t>(card.received_ % io->buffer_size);
    };
    callbacks.transfer = [](snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas, snd_pcm_uframes_t offset,
                            snd_pcm_uframes_t size) { return of(io).give(areas, offset, size); };
    callbacks.poll_revents = [](snd_pcm_ioplug_t* io, pollfd*, unsigned, unsigned short* events) {
      Card& card = of(io);
      card.receive();
      const bool is_ready = card.received_ - card.given_ >= io->period_size;
      *events = static_cast<unsigned short>(card.is_gone_ ? POLLERR : is_ready ? POLLIN : 0);
      return 0;
    };
    callbacks.close = [](snd_pcm_ioplug_t* io) {
      const std::unique_ptr<Card> card(&of(io));
      return 0;
    };
    return callbacks;
  }

  void prepare(snd_pcm_uframes_t frames) {
    ring_.assign(frames * channels_, 0.0F);
    received_ = 0;
    given_ = 0;
  }

  /// What came while nobody recorded is old; frames stay whole.
  void skip_old_sound() {
    for (std::uint64_t before = received_ - 1; before != received_;) {
      before = received_;
      receive();
      given_ = received_;
    }
    received_ = given_ = 0;
  }

  /// Takes what has come, as far as there is room: one frame is left free, since a full ring would look like an empty
  /// one.
  void receive() {
    if (ring_.empty()) return;
    const std::size_t frames = ring_.size() / channels_;
    const std::size_t frame_bytes = channels_ * sizeof(float);
    while (!is_gone_ && received_ - given_ + 1 < frames) {
      std::array<char, 4096> block{};
      const std::size_t room = (frames - 1 - (received_ - given_)) * frame_bytes - partial_.size();
      const ssize_t size = recv(socket_, block.data(), std::min(block.size(), room), MSG_DONTWAIT);
      if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
      if (size <= 0) {
        is_gone_ = true;
        return;
      }
      partial_.insert(partial_.end(), block.begin(), block.begin() + size);
      const std::size_t whole = partial_.size() / frame_bytes;
      for (std::size_t i = 0; i < whole; ++i, ++received_) {
        std::memcpy(&ring_[received_ % frames * channels_], &partial_[i * frame_bytes], frame_bytes);
      }
      partial_.erase(partial_.begin(), partial_.begin() + static_cast<std::ptrdiff_t>(whole * frame_bytes));
    }
  }

  snd_pcm_sframes_t give(const snd_pcm_channel_area_t* areas, snd_pcm_uframes_t offset, snd_pcm_uframes_t size) {
    const std::size_t frames = ring_.size() / channels_;
    for (snd_pcm_uframes_t i = 0; i < size; ++i, ++given_) {
      for (unsigned channel = 0; channel < channels_; ++channel) {
        const snd_pcm_channel_area_t& area = areas[channel];
        char* const to = static_cast<char*>(area.addr) + (area.first + (offset + i) * area.step) / 8;
        std::memcpy(to, &ring_[given_ % frames * channels_ + channel], sizeof(float));
      }
    }
    return static_cast<snd_pcm_sframes_t>(size);
  }

  snd_pcm_ioplug_t io_{};
  int socket_;
  unsigned channels_;
  unsigned rate_;
  std::vector<float> ring_;
  std::vector<char> partial_;  ///< the beginning of a frame
  std::uint64_t received_ = 0;
  std::uint64_t given_ = 0;
  bool is_gone_ = false;
};

int connect_to(const char* path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (std::strlen(path) >= sizeof address.sun_path) return -ENAMETOOLONG;
  std::memcpy(address.sun_path, path, std::strlen(path));
  const int socket_fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket_fd < 0) return -errno;
  if (connect(socket_fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_fd);
    return -ENODEV;
  }
  return socket_fd;
}

}  // namespace

extern "C" {

SND_PCM_PLUGIN_DEFINE_FUNC(windsim) {
  static_cast<void>(root);
  if (stream != SND_PCM_STREAM_CAPTURE) return -EINVAL;
  const char* path = nullptr;
  long channels = 1;
  long rate = 48000;
  snd_config_iterator_t at = nullptr;
  snd_config_iterator_t next = nullptr;
  snd_config_for_each(at, next, conf) {
    snd_config_t* const field = snd_config_iterator_entry(at);
    const char* id = nullptr;
    if (snd_config_get_id(field, &id) < 0) continue;
    const std::string_view key = id;
    if (key == "path") snd_config_get_string(field, &path);
    if (key == "channels") snd_config_get_integer(field, &channels);
    if (key == "rate") snd_config_get_integer(field, &rate);
  }
  if (path == nullptr || channels < 1 || rate < 1) return -EINVAL;

  const int socket_fd = connect_to(path);
  if (socket_fd < 0) return socket_fd;
  auto card = std::make_unique<Card>(socket_fd, static_cast<unsigned>(channels), static_cast<unsigned>(rate));
  const int error = card->open(pcmp, name, stream, mode);
  if (error < 0) return error;
  static_cast<void>(card.release());  // the PCM's own from now on: its close callback ends it
  return 0;
}

SND_PCM_PLUGIN_SYMBOL(windsim)

}  // extern "C"
