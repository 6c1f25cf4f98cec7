#include "drivers/bus/dns_message.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <arpa/inet.h>
#include <arpa/nameser.h>
#include <netinet/in.h>
#include <resolv.h>

#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::bus {
namespace {

constexpr std::size_t kMaxServices = 16;
/// No message of multicast DNS is longer (RFC 6762, section 17).
constexpr std::size_t kMaxMessage = 9000;
constexpr std::size_t kMaxLabel = 63;
/// The class of a record, without the bit that makes others discard cached records (RFC 6762, section 10.2).
constexpr unsigned kClassMask = 0x7FFF;

using DomainName = std::array<char, NS_MAXDNAME>;

/// The name that begins there in the message, which may end elsewhere in it.
std::optional<std::string> name_at(const ns_msg& message, const std::uint8_t* from) {
  DomainName name{};
  if (ns_name_uncompress(ns_msg_base(message), ns_msg_end(message), from, name.data(), name.size()) < 0) return {};
  return name.data();
}

/// Calls `take` with each record of the answer section and of the additional section.
template <class Take>
void for_each_record(ns_msg& message, Take&& take) {
  for (const ns_sect section : {ns_s_an, ns_s_ar}) {
    for (int i = 0; i < ns_msg_count(message, section); ++i) {
      ns_rr record{};
      if (ns_parserr(&message, section, i, &record) != 0) return;
      if ((ns_rr_class(record) & kClassMask) == ns_c_in) take(record);
    }
  }
}

/// Names differ by more than the case of their letters (RFC 1035, section 2.3.3).
bool is_same_name(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

/// "Mast", of "Mast._signalk-ws._tcp.local"; a label as the resolver writes it, with "\032" for a blank.
std::string first_label(const std::string& name) {
  std::string label;
  for (std::size_t i = 0; i < name.size() && name[i] != '.'; ++i) {
    const auto is_digit = [&](std::size_t at) { return at < name.size() && name[at] >= '0' && name[at] <= '9'; };
    if (name[i] == '\\' && is_digit(i + 1) && is_digit(i + 2) && is_digit(i + 3)) {
      label += static_cast<char>((name[i + 1] - '0') * 100 + (name[i + 2] - '0') * 10 + (name[i + 3] - '0'));
      i += 3;
      continue;
    }
    if (name[i] == '\\' && i + 1 < name.size()) ++i;
    label += name[i];
  }
  make_printable(label);
  return shortened(label, kMaxLabel);
}

}  // namespace

std::vector<std::uint8_t> service_question(const std::string& type) {
  std::vector<std::uint8_t> question(NS_PACKETSZ);
  const int size = res_mkquery(ns_o_query, type.c_str(), ns_c_in, ns_t_ptr, nullptr, 0, nullptr, question.data(),
                               static_cast<int>(question.size()));
  question.resize(size < NS_HFIXEDSZ ? 0 : static_cast<std::size_t>(size));
  // Neither an id nor flags: no server is asked to look further.
  std::fill_n(question.begin(), std::min<std::size_t>(question.size(), 4), std::uint8_t{0});
  return question;
}

std::vector<AnnouncedService> services_in(std::span<const std::uint8_t> bytes, const std::string& type) {
  std::vector<AnnouncedService> services;
  if (bytes.size() > kMaxMessage) return services;
  ns_msg message{};
  if (ns_initparse(bytes.data(), static_cast<int>(bytes.size()), &message) != 0) return services;
  if (ns_msg_getflag(message, ns_f_qr) == 0) return services;

  std::vector<std::string> names;
  for_each_record(message, [&](const ns_rr& record) {
    if (ns_rr_type(record) != ns_t_ptr || !is_same_name(ns_rr_name(record), type)) return;
    auto name = name_at(message, ns_rr_rdata(record));
    const auto is_known = [&](const std::string& other) { return is_same_name(*name, other); };
    if (name && names.size() < kMaxServices && std::ranges::none_of(names, is_known)) names.push_back(*name);
  });
  for (const std::string& name : names) {
    AnnouncedService service{.name = first_label(name)};
    std::string host;
    for_each_record(message, [&](const ns_rr& record) {
      constexpr std::ptrdiff_t kPortAt = 2L * NS_INT16SZ;  // after priority and weight
      constexpr std::ptrdiff_t kBeforeTarget = 3L * NS_INT16SZ;
      if (ns_rr_type(record) != ns_t_srv || ns_rr_rdlen(record) <= kBeforeTarget || !host.empty()) return;
      if (!is_same_name(ns_rr_name(record), name)) return;
      service.port = static_cast<std::uint16_t>(ns_get16(ns_rr_rdata(record) + kPortAt));
      host = name_at(message, ns_rr_rdata(record) + kBeforeTarget).value_or("");
    });
    for_each_record(message, [&](const ns_rr& record) {
      if (ns_rr_type(record) != ns_t_a || ns_rr_rdlen(record) != NS_INADDRSZ || !service.address.empty()) return;
      if (host.empty() || !is_same_name(ns_rr_name(record), host)) return;
      std::array<char, INET_ADDRSTRLEN> text{};
      inet_ntop(AF_INET, ns_rr_rdata(record), text.data(), text.size());
      service.address = text.data();
    });
    services.push_back(std::move(service));
  }
  return services;
}

}  // namespace yuragi::drivers::bus
