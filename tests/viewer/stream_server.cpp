#include "tests/viewer/stream_server.hpp"

#include <array>
#include <chrono>
#include <deque>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "engine/wire/message_reader.hpp"

namespace yuragi::viewer {
namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

struct StreamServer::Client {
  explicit Client(tcp::socket taken) : socket(std::move(taken)) {}
  tcp::socket socket;
  wire::MessageReader reader{wire::kMaxClientMessageBytes};
  std::array<std::uint8_t, 512> received{};
  std::deque<wire::Bytes> waiting;
  bool has_subscribed = false;
};

StreamServer::StreamServer(wire::Bytes greeting, std::uint16_t port)
    : greeting_(std::move(greeting)), acceptor_(context_, tcp::endpoint(asio::ip::address_v4::loopback(), port)) {
  port_ = acceptor_.local_endpoint().port();
  accept();
  thread_ = std::thread([this] { context_.run(); });
}

StreamServer::~StreamServer() {
  context_.stop();
  thread_.join();
}

void StreamServer::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error) return;
    auto client = std::make_shared<Client>(std::move(socket));
    clients_.push_back(client);
    client->waiting.push_back(greeting_);
    write_next(client);
    read_subscription(client);
    accept();
  });
}

void StreamServer::read_subscription(const std::shared_ptr<Client>& client) {
  client->socket.async_read_some(asio::buffer(client->received), [this, client](error_code error, std::size_t count) {
    if (error) return clients_.remove(client), void();
    client->reader.feed(std::span(client->received).first(count));
    while (auto message = client->reader.next()) {
      if (!*message) continue;
      const std::lock_guard lock(mutex_);
      if (const auto* subscribe = std::get_if<wire::Subscribe>(&**message)) {
        client->has_subscribed = true;
        token_ = subscribe->token;
        ++subscriptions_;
      } else if (const auto* control = std::get_if<wire::Control>(&**message)) {
        controls_.push_back(*control);
      } else if (const auto* display = std::get_if<wire::Display>(&**message)) {
        given_up_ = display->given_up;
      }
      subscribed_.notify_all();
    }
    read_subscription(client);
  });
}

void StreamServer::write_next(const std::shared_ptr<Client>& client) {
  asio::async_write(client->socket, asio::buffer(client->waiting.front()),
                    [this, client](error_code error, std::size_t) {
                      if (error) return;
                      client->waiting.pop_front();
                      if (!client->waiting.empty()) write_next(client);
                    });
}

void StreamServer::send(wire::Bytes bytes) {
  asio::post(context_, [this, bytes = std::move(bytes)] {
    for (const auto& client : clients_) {
      if (!client->has_subscribed) continue;
      client->waiting.push_back(bytes);
      if (client->waiting.size() == 1) write_next(client);
    }
  });
}

void StreamServer::cut() {
  asio::post(context_, [this] {
    for (const auto& client : clients_) client->socket.close();
    clients_.clear();
  });
}

bool StreamServer::wait_for_subscriptions(std::size_t count) {
  std::unique_lock lock(mutex_);
  return subscribed_.wait_for(lock, std::chrono::seconds(30), [&] { return subscriptions_ >= count; });
}

std::vector<wire::Control> StreamServer::wait_for_controls(std::size_t count) {
  std::unique_lock lock(mutex_);
  subscribed_.wait_for(lock, std::chrono::seconds(30), [&] { return controls_.size() >= count; });
  return controls_;
}

wire::Bytes operator+(wire::Bytes a, const wire::Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace yuragi::viewer
