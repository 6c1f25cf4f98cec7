#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi {

/// An answer of multicast DNS, written byte by byte after RFC 1035, section 4.1: the other side of what is tested.
class DnsAnswer {
 public:
  static constexpr std::uint16_t kA = 1;
  static constexpr std::uint16_t kPtr = 12;
  static constexpr std::uint16_t kTxt = 16;
  static constexpr std::uint16_t kSrv = 33;

  /// A record; `data` after its length.
  DnsAnswer& add(const std::string& name, std::uint16_t type, const std::string& data) {
    ++records_;
    body_ += name_of(name) + number(type) + number(0x8001) + number(0) + number(120) +
             number(static_cast<std::uint16_t>(data.size())) + data;
    return *this;
  }
  DnsAnswer& add_service(const std::string& type, const std::string& label, const std::string& host, std::uint16_t port,
                         const std::string& address) {
    const std::string instance = label + '\0' + type;  // the label may have dots in it
    add(type, kPtr, name_of(instance));
    add(instance, kSrv, number(0) + number(0) + number(port) + name_of(host));
    add(instance, kTxt, "\x06path=/");
    return add(host, kA, address);
  }

  std::vector<std::uint8_t> bytes() const {
    const std::string all = number(0) + number(0x8400) + number(0) + number(records_) + number(0) + number(0) + body_;
    return {all.begin(), all.end()};
  }

  static std::string number(std::uint16_t value) {
    return {static_cast<char>(value >> 8U), static_cast<char>(value & 0xFFU)};
  }
  /// "a.b" as labels; up to a zero byte it is one label.
  static std::string name_of(std::string_view text) {
    std::string name;
    const auto add = [&name](std::string_view label) {
      name += static_cast<char>(label.size());
      name += label;
    };
    if (const auto end = text.find('\0'); end != std::string_view::npos) {
      add(text.substr(0, end));
      text.remove_prefix(end + 1);
    }
    for (auto dot = text.find('.'); dot != std::string_view::npos; dot = text.find('.')) {
      add(text.substr(0, dot));
      text.remove_prefix(dot + 1);
    }
    add(text);
    return name + '\0';
  }

 private:
  std::uint16_t records_ = 0;
  std::string body_;
};

}  // namespace yuragi
