#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "daemon/http/byte_stream.hpp"
#include "daemon/stream/client_admission.hpp"

namespace yuragi::daemon::http {

/// A connection that leaves HTTP for another protocol, with the request for it.
struct Upgrade {
  ByteStream bytes;
  boost::beast::http::request<boost::beast::http::string_body> request;
  stream::Peer client;
};

}  // namespace yuragi::daemon::http
