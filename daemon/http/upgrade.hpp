#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "daemon/stream/client_admission.hpp"

namespace yuragi::daemon::http {

/// A connection that leaves HTTP for another protocol, with the request for it.
struct Upgrade {
  boost::asio::ip::tcp::socket socket;
  boost::beast::http::request<boost::beast::http::string_body> request;
  stream::Peer client;
};

}  // namespace yuragi::daemon::http
