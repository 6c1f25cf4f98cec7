// The link with Debian's nats-server.
#include "daemon/follow/nats_link.hpp"

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/nats_server.hpp"
#include "tests/support/tls_server.hpp"

namespace yuragi::daemon::follow {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

NatsSettings settings_of(std::vector<std::string> servers, std::filesystem::path credentials = {},
                         std::filesystem::path authorities = {}) {
  NatsSettings settings;
  settings.servers = std::move(servers);
  settings.name = "test";
  settings.credentials = std::move(credentials);
  settings.authorities = std::move(authorities);
  return settings;
}

/// A link, and what it has received.
class Peer {
 public:
  Peer(NatsSettings settings, std::vector<std::string> subjects) {
    // It is destroyed with the last of the link's threads.
    const std::shared_ptr<void> end(nullptr, [this](void*) {
      const std::lock_guard lock(mutex_);
      has_ended_ = true;
      come_.notify_all();
    });
    link_.emplace(std::move(settings), std::move(subjects), [this, end] {
      const std::lock_guard lock(mutex_);
      has_come_ = true;
      come_.notify_all();
    });
  }
  Peer(std::vector<std::string> servers, std::vector<std::string> subjects)
      : Peer(settings_of(std::move(servers)), std::move(subjects)) {}

  ~Peer() {
    link_.reset();
    std::unique_lock lock(mutex_);
    come_.wait(lock, [this] { return has_ended_; });
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  NatsLink& link() { return *link_; }

  /// Waits for a state. Only a hang takes longer.
  template <class Condition>
  NatsLink::State until(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      NatsLink::State state = link_->state();
      if (condition(state)) return state;
      wait();
    }
    throw std::runtime_error("the state does not come; trouble: " + link_->state().trouble);
  }
  NatsLink::State until_connected() {
    return until([](const NatsLink::State& state) { return state.is_connected; });
  }
  NatsLink::State until_trouble() {
    return until([](const NatsLink::State& state) { return !state.trouble.empty(); });
  }

  /// The next message of a subject; the others are dropped. `meanwhile` is called again and again.
  NatsMessage next(
      const std::string& subject, const std::function<void()>& meanwhile = [] {}) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      while (!messages_.empty()) {
        NatsMessage message = std::move(messages_.front());
        messages_.erase(messages_.begin());
        if (message.subject == subject) return message;
      }
      meanwhile();
      messages_ = link_->received();
      if (messages_.empty()) wait();
    }
    throw std::runtime_error("no message of " + subject + "; trouble: " + link_->state().trouble);
  }

 private:
  void wait() {
    std::unique_lock lock(mutex_);
    come_.wait_for(lock, std::chrono::milliseconds(5), [this] { return has_come_; });
    has_come_ = false;
  }

  std::mutex mutex_;
  std::condition_variable come_;
  bool has_come_ = false, has_ended_ = false;
  std::vector<NatsMessage> messages_;
  std::optional<NatsLink> link_;
};

/// Waits until messages of `from` arrive at `to`.
void connect(Peer& from, Peer& to, const std::string& subject) {
  from.until_connected();
  to.next(subject, [&] { from.link().publish(subject, bytes_of("hello")); });
}

TEST(NatsLinkTest, AMessageArrivesAsItWasPublished) {
  const NatsServer server;
  Peer sender({server.address()}, {});
  Peer reader({server.address()}, {"y.>"});
  connect(sender, reader, "y.hello");
  const std::vector<std::uint8_t> bytes = {0, 255, '\r', '\n', 0, 'a'};
  sender.link().publish("y.tick", bytes);
  const NatsMessage message = reader.next("y.tick");
  EXPECT_EQ(message.bytes, bytes);
  EXPECT_THAT(message.reply_to, IsEmpty());
  sender.link().publish("y.empty", {});
  EXPECT_THAT(reader.next("y.empty").bytes, IsEmpty());

  const NatsLink::State sent = sender.link().state();
  EXPECT_EQ(sent.server, server.address());
  EXPECT_EQ(sent.connections, 1U);
  EXPECT_EQ(sent.lost, 0U);
  EXPECT_GE(sent.sent, 3U);
  EXPECT_EQ(sent.sent_bytes, (sent.sent - 2) * 5 + bytes.size());
  const NatsLink::State received = reader.link().state();
  EXPECT_EQ(received.received_bytes, (received.received - 2) * 5 + bytes.size());
  EXPECT_THAT(received.trouble, IsEmpty());
  EXPECT_EQ(NatsLink::refusal(), std::nullopt);
}

TEST(NatsLinkTest, AReplyComesToTheInbox) {
  const NatsServer server;
  Peer asks({server.address()}, {}), replies({server.address()}, {"y.ask"});
  EXPECT_NE(asks.link().inbox(), replies.link().inbox());
  asks.until_connected();
  const NatsMessage request =
      replies.next("y.ask", [&] { asks.link().publish("y.ask", bytes_of("?"), asks.link().inbox()); });
  EXPECT_EQ(request.reply_to, asks.link().inbox());
  replies.link().publish(request.reply_to, bytes_of("!"));
  EXPECT_EQ(asks.next(asks.link().inbox()).bytes, bytes_of("!"));
}

TEST(NatsLinkTest, ARequestThatNobodyAnswersBringsNothing) {
  const NatsServer server;
  Peer asks({server.address()}, {"y.own"});
  asks.until_connected();
  asks.link().publish("y.nobody", bytes_of("?"), asks.link().inbox());
  asks.link().publish("y.own", bytes_of("later"));  // by the same way, so after what the server would send
  asks.next("y.own");
  EXPECT_EQ(asks.link().state().received, 1U);
}

TEST(NatsLinkTest, ASnapshotInChunksArrivesWholeAndInOrder) {
  const NatsServer server;
  Peer sender({server.address()}, {}), reader({server.address()}, {"y.chunk", "y.hello"});
  connect(sender, reader, "y.hello");
  constexpr int kChunks = 15;
  std::vector<std::uint8_t> chunk(std::size_t{128} * 1024);
  for (int i = 0; i < kChunks; ++i) {
    std::iota(chunk.begin(), chunk.end(), static_cast<std::uint8_t>(i));
    sender.link().publish("y.chunk", chunk);
  }
  for (int i = 0; i < kChunks; ++i) {
    std::iota(chunk.begin(), chunk.end(), static_cast<std::uint8_t>(i));
    ASSERT_EQ(reader.next("y.chunk").bytes, chunk) << i;
  }
  EXPECT_EQ(sender.link().state().lost, 0U);
}

TEST(NatsLinkTest, AKilledServerIsReplacedByTheNext) {
  NatsPair pair;
  Peer sender({pair.second.address()}, {}), reader({pair.first.address(), pair.second.address()}, {"y.tick"});
  connect(sender, reader, "y.tick");
  EXPECT_EQ(reader.link().state().server, pair.first.address());
  pair.first.kill();
  reader.until([&](const NatsLink::State& state) { return state.connections == 2; });
  connect(sender, reader, "y.tick");
  EXPECT_EQ(reader.link().state().server, pair.second.address());
  EXPECT_THAT(reader.link().state().trouble, IsEmpty());
}

TEST(NatsLinkTest, AServerThatHangsIsLeft) {
  NatsPair pair;
  Peer sender({pair.second.address()}, {}), reader({pair.first.address(), pair.second.address()}, {"y.tick"});
  connect(sender, reader, "y.tick");
  pair.first.hold();
  reader.link().leave_server();
  reader.until([&](const NatsLink::State& state) { return state.connections == 2; });
  EXPECT_EQ(reader.link().state().server, pair.second.address());
  connect(sender, reader, "y.tick");
}

/// Publishes more than sockets hold.
void flood(NatsLink& link) {
  const std::vector<std::uint8_t> chunk(std::size_t{128} * 1024);
  const std::uint64_t lost = link.state().lost;
  while (link.state().lost == lost) link.publish("y.flood", chunk);
}

TEST(NatsLinkTest, AServerThatHangsIsLeftEvenIfNothingMoreCanBeSentToIt) {
  NatsPair pair;
  Peer sender({pair.first.address(), pair.second.address()}, {}), reader({pair.second.address()}, {"y.tick"});
  connect(sender, reader, "y.tick");
  pair.first.hold();
  flood(sender.link());
  sender.link().leave_server();
  sender.until([&](const NatsLink::State& state) { return state.connections == 2; });
  connect(sender, reader, "y.tick");
}

TEST(NatsLinkTest, ItEndsAlthoughTheServerHangs) {
  const NatsServer server;
  for (const bool is_full : {false, true}) {
    Peer sender({server.address()}, {});
    sender.until_connected();
    server.hold();
    if (is_full) flood(sender.link());
    // Only a hang takes so long that the test's own time is over.
    { const Peer gone({server.address()}, {}); }
    if (!is_full) server.go_on();
  }
}

TEST(NatsLinkTest, WhatWasPublishedLastArrives) {
  const NatsServer server;
  Peer reader({server.address()}, {"y.>"});
  {
    Peer sender({server.address()}, {});
    connect(sender, reader, "y.hello");
    sender.link().publish("y.last", bytes_of("goodbye"));
  }
  EXPECT_EQ(reader.next("y.last").bytes, bytes_of("goodbye"));
}

TEST(NatsLinkTest, AServerMayComeLater) {
  NatsServer server("", false);
  Peer peer({server.address()}, {"y.tick"});
  EXPECT_THAT(peer.until_trouble().trouble, HasSubstr("cannot reach " + server.address() + ": check its address"));
  peer.link().publish("y.tick", bytes_of("lost"));
  EXPECT_EQ(peer.link().state().lost, 1U);
  server.start();
  connect(peer, peer, "y.tick");
  server.kill();
  EXPECT_THAT(peer.until_trouble().trouble, HasSubstr(server.address()));
  server.start();
  peer.until([](const NatsLink::State& state) { return state.connections == 2; });
  connect(peer, peer, "y.tick");
}

TEST(NatsLinkTest, MessagesOverALimitAreCountedAndDropped) {
  const NatsServer server;
  Peer sender({server.address()}, {});
  NatsSettings settings = settings_of({server.address()});
  settings.max_message_bytes = 1000;
  settings.max_waiting = 10;
  Peer reader(settings, {"y.>"});
  sender.until_connected();
  reader.until_connected();
  reader.link().publish(reader.link().inbox(), {});  // when it is back, the server knows what the reader subscribes to
  reader.until([](const NatsLink::State& state) { return state.received == 1; });
  EXPECT_THAT(reader.link().received(), SizeIs(1));
  constexpr int kMany = 30;
  const auto publish_many = [&](std::size_t size) {
    const NatsLink::State before = reader.link().state();
    for (int i = 0; i < kMany; ++i) sender.link().publish("y.many", std::vector<std::uint8_t>(size));
    reader.until(
        [&](const NatsLink::State& now) { return now.received + now.lost == before.received + before.lost + kMany; });
  };
  publish_many(settings.max_message_bytes + 1);
  EXPECT_EQ(reader.link().state().lost, 30U);
  EXPECT_THAT(reader.link().received(), IsEmpty());
  publish_many(settings.max_message_bytes);
  EXPECT_EQ(reader.link().state().lost, 50U);
  EXPECT_THAT(reader.link().received(), SizeIs(10));

  const std::uint64_t lost = sender.link().state().lost;
  sender.link().publish("y.long", std::vector<std::uint8_t>(256 * 1024 + 1));
  sender.link().publish("y.two words", {});
  sender.link().publish("y.line\r\nPUB", {});
  sender.link().publish("", {});
  sender.link().publish("y.reply", {}, "two words");
  EXPECT_EQ(sender.link().state().lost, lost + 5);
  EXPECT_TRUE(sender.link().state().is_connected);
}

/// A server with the user "wall" and the password "swordfish", who may not publish to y.secret or subscribe to it.
constexpr const char* kOneUser =
    "authorization { users: [ { user: wall, password: swordfish, permissions: {\n"
    "  publish: { deny: \"y.secret\" }, subscribe: { deny: \"y.secret\" } } } ] }\n";

class Credentials {
 public:
  explicit Credentials(const std::string& text) {
    std::ofstream(file()) << text << '\n';
    std::filesystem::permissions(file(), std::filesystem::perms::owner_read);
  }
  std::filesystem::path file() const { return folder_ / "credentials"; }

 private:
  test::TemporaryFolder folder_;
};

TEST(NatsLinkTest, AWrongPasswordIsATrouble) {
  const NatsServer server(kOneUser);
  const Credentials wrong("wall:sword"), right("wall:swordfish");
  Peer refused(settings_of({server.address()}, wrong.file()), {});
  EXPECT_THAT(refused.until_trouble().trouble, HasSubstr("does not accept this user: check the file of credentials"));
  Peer accepted(settings_of({server.address()}, right.file()), {"y.tick"});
  connect(accepted, accepted, "y.tick");

  std::filesystem::permissions(right.file(), std::filesystem::perms::others_read, std::filesystem::perm_options::add);
  Peer exposed(settings_of({server.address()}, right.file()), {});
  EXPECT_THAT(exposed.until_trouble().trouble, HasSubstr("chmod 640"));
  const Credentials neither("something");
  Peer unclear(settings_of({server.address()}, neither.file()), {});
  EXPECT_THAT(unclear.until_trouble().trouble, HasSubstr("neither user:password nor the seed of an nkey"));
}

TEST(NatsLinkTest, WhatIsNotPermittedIsATrouble) {
  const NatsServer server(kOneUser);
  const Credentials credentials("wall:swordfish");
  const NatsSettings settings = settings_of({server.address()}, credentials.file());
  Peer subscribes(settings, {"y.secret", "y.tick"});
  EXPECT_THAT(subscribes.until_trouble().trouble,
              testing::AllOf(HasSubstr("does not permit"), HasSubstr("y.secret"), HasSubstr("change the permissions")));
  connect(subscribes, subscribes, "y.tick");
  Peer publishes(settings, {});
  publishes.until_connected();
  publishes.link().publish("y.secret", bytes_of("?"));
  EXPECT_THAT(publishes.until_trouble().trouble, HasSubstr("y.secret"));
  EXPECT_TRUE(publishes.link().state().is_connected);
}

TEST(NatsLinkTest, AnNkeyIsAccepted) {
  const NatsServer server(
      "authorization { users: [ { nkey: UDXU4RCSJNZOIQHZNWXHXORDPRTGNJAHAHFRGZNEEJCPQTT2M7NLCNF4 } ] }\n");
  const Credentials credentials("SUACSSL3UAHUDXKFSNVUZRF5UHPMWZ6BFDTJ7M6USDXIEDNPPQYYYCU3VY");
  Peer peer(settings_of({server.address()}, credentials.file()), {"y.tick"});
  connect(peer, peer, "y.tick");
  Peer refused({server.address()}, {});
  EXPECT_THAT(refused.until_trouble().trouble, HasSubstr("does not accept this user"));
}

/// A certificate of its own, and the lines of a server's configuration that use it.
class Tls {
 public:
  explicit Tls(const std::string& names) {
    const SelfSignedCertificate certificate(names);
    certificate.save(authorities());
    certificate.save_key(folder_ / "key.pem");
  }
  std::filesystem::path authorities() const { return folder_ / "cert.pem"; }
  std::string lines() const {
    return "tls { cert_file: \"" + authorities().string() + "\", key_file: \"" + (folder_ / "key.pem").string() +
           "\" }\n";
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(NatsLinkTest, TlsIsVerified) {
  const Tls own("DNS:localhost,IP:127.0.0.1"), foreign("DNS:localhost"), elsewhere("DNS:example.org");
  const NatsServer server(own.lines()), other(elsewhere.lines()), plain;
  // By nats:// there is TLS if the server requires it.
  for (const std::string& address :
       {server.address("tls", "localhost"), server.address("tls"), server.address(), plain.address()}) {
    Peer peer(settings_of({address}, "", own.authorities()), {"y.tick"});
    connect(peer, peer, "y.tick");
  }
  const auto trouble = [](const std::string& address, const std::filesystem::path& authorities) {
    Peer peer(settings_of({address}, "", authorities), {});
    return peer.until_trouble().trouble;
  };
  EXPECT_THAT(trouble(server.address("tls", "localhost"), foreign.authorities()), HasSubstr("check the authorities"));
  EXPECT_THAT(trouble(server.address("tls", "localhost"), ""), HasSubstr("check the authorities"));
  for (const char* const scheme : {"tls", "nats"}) {
    EXPECT_THAT(trouble(other.address(scheme), elsewhere.authorities()), HasSubstr("check the authorities"));
  }
  EXPECT_THAT(trouble(plain.address("tls"), own.authorities()), HasSubstr("offers no TLS"));
}

TEST(NatsLinkTest, ATlsServerThatHangsIsLeftEvenIfNothingMoreCanBeSentToIt) {
  const Tls tls("DNS:localhost,IP:127.0.0.1");
  const NatsServer first(tls.lines()), second(tls.lines());
  const std::vector<std::string> servers = {first.address("tls", "localhost"), second.address("tls", "localhost")};
  Peer peer(settings_of(servers, "", tls.authorities()), {"y.tick"});
  connect(peer, peer, "y.tick");
  first.hold();
  flood(peer.link());
  peer.link().leave_server();
  peer.until([](const NatsLink::State& state) { return state.connections == 2; });
  connect(peer, peer, "y.tick");
}

TEST(NatsLinkTest, AHandshakeThatHangsIsLeftBehind) {
  // It sends what a server with TLS sends first, and no more.
  const LoopbackPort port(SOCK_STREAM);
  ASSERT_EQ(listen(port.descriptor(), 8), 0);
  Descriptor client;
  std::thread hanging([&] {
    client = Descriptor(accept4(port.descriptor(), nullptr, nullptr, SOCK_CLOEXEC));
    const std::string info = "INFO {\"server_id\":\"a\",\"version\":\"2.9.10\",\"tls_required\":true}\r\n";
    EXPECT_EQ(send(client.get(), info.data(), info.size(), MSG_NOSIGNAL), static_cast<ssize_t>(info.size()));
  });
  const NatsServer server;
  Peer peer({"tls://127.0.0.1:" + std::to_string(port.port()), server.address()}, {"y.tick"});
  connect(peer, peer, "y.tick");
  EXPECT_EQ(peer.link().state().server, server.address());
  hanging.join();
  client.reset();  // which ends the thread that was left behind
}

}  // namespace
}  // namespace yuragi::daemon::follow
