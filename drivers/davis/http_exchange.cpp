#include "drivers/davis/http_exchange.hpp"

#include <sstream>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/system/result.hpp>
#include <fmt/format.h>

namespace yuragi::drivers::davis {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t kMaxHeader = 8 * 1024;
constexpr std::uint64_t kMaxBody = 64UL * 1024;

}  // namespace

struct HttpExchange::Parser {
  Parser() {
    parser.eager(true);
    parser.header_limit(kMaxHeader);
    parser.body_limit(kMaxBody);
  }
  http::response_parser<http::string_body> parser;
  std::string rest;  ///< bytes that it has not taken yet: the beginning of a line
};

HttpExchange::HttpExchange(std::string host, std::unique_ptr<bus::BytePort> port)
    : host_(std::move(host)), port_(std::move(port)) {}

HttpExchange::~HttpExchange() = default;

Result<void, Failure> HttpExchange::begin(const std::string& target) {
  end();
  if (const auto opened = port_->open(); !opened) return opened.error();
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, host_);
  request.set(http::field::accept, "application/json");
  request.set(http::field::connection, "close");
  std::ostringstream text;
  text << request;
  const std::string bytes = std::move(text).str();
  if (!port_->write({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})) {
    end();
    return Failure{"the connection was lost"};
  }
  parser_ = std::make_unique<Parser>();
  return {};
}

std::optional<Result<std::string, Failure>> HttpExchange::advance(Nanoseconds timeout) {
  const auto give_up = [this](std::string why) {
    end();
    return Failure{std::move(why)};
  };
  if (!is_under_way()) return give_up("no request is in progress");
  const bus::ByteArrival arrival = port_->read(buffer_, timeout);
  auto& parser = parser_->parser;
  boost::system::error_code error;
  if (arrival.status == bus::ByteStatus::kLost) {
    parser.put_eof(error);
    if (!error && !parser.is_done()) error = http::error::end_of_stream;
  } else if (arrival.status == bus::ByteStatus::kBytes) {
    std::string& rest = parser_->rest;
    rest.append(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(arrival.size));
    while (!rest.empty() && !parser.is_done()) {
      const std::size_t taken = parser.put(boost::asio::buffer(rest), error);
      rest.erase(0, taken);
      if (error == http::error::need_more) error = {};
      if (error || taken == 0) break;
    }
  }
  if (error) return give_up("not an HTTP reply: " + error.message());
  if (!parser.is_done()) return std::nullopt;
  const unsigned status = parser.get().result_int();
  if (status != 200) return give_up(fmt::format("the reply is HTTP {}", status));
  std::string body = std::move(parser.get().body());
  end();
  return Result<std::string, Failure>(boost::system::in_place_value, std::move(body));
}

void HttpExchange::end() noexcept {
  parser_.reset();
  port_->close();
}

}  // namespace yuragi::drivers::davis
