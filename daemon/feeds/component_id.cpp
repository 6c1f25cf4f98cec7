#include "daemon/feeds/component_id.hpp"

#include <algorithm>

#include <boost/asio/ip/host_name.hpp>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid.hpp>

#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::feeds {

ComponentId component_id_of(std::string_view machine, std::string_view feed) {
  // Of this program: random, never to be changed.
  static constexpr boost::uuids::uuid kYuragi = {
      {0x6f, 0x0b, 0x5e, 0xd1, 0x8a, 0x43, 0x4c, 0x1e, 0x9d, 0x27, 0x35, 0xc4, 0x7e, 0x60, 0xb2, 0x19}};
  std::string name(machine);
  name.append("\n").append(feed);
  const boost::uuids::uuid uuid = boost::uuids::name_generator_sha1(kYuragi)(name);
  ComponentId id{};
  std::copy(uuid.begin(), uuid.end(), id.begin());
  return id;
}

std::string machine_id() {
  constexpr std::size_t kMost_bytes = 256;
  const auto text = platform::read_whole("/etc/machine-id", kMost_bytes);
  boost::system::error_code ignored;
  return text && !text->empty() ? *text : boost::asio::ip::host_name(ignored);
}

}  // namespace yuragi::daemon::feeds
