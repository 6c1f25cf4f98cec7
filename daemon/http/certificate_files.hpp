#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace boost::asio::ssl {
class context;
}

namespace yuragi::daemon::http {

/// The certificate of a server and its key, as PEM files that are renewed while the server runs. TLS 1.2 or newer
/// (E. Rescorla, RFC 8446, 2018). Thread-safe: yes.
class CertificateFiles {
 public:
  /// So long before the end of a certificate a person should know: Let's Encrypt's is renewed 30 days before.
  static constexpr std::chrono::hours kExpiresSoon{14 * 24};

  /// `certificate`: with those that link it to a root, if there are some. `key`: without a password. Reads both and
  /// waits for the disk. Throws FailureError with the file if one cannot be read or used, if they do not belong
  /// together, or if the certificate has expired.
  CertificateFiles(std::filesystem::path certificate, std::filesystem::path key);

  /// For the next connection; those that exist keep theirs.
  std::shared_ptr<boost::asio::ssl::context> context() const;

  /// Begins to read both again, on a thread of its own. If they cannot be used, the context stays.
  void read_again();

  /// Returns why the files cannot be used since they were read last, or that the certificate has expired or soon will;
  /// nullopt: all is well.
  std::optional<std::string> trouble(std::chrono::system_clock::time_point now) const;

 private:
  struct Shared;  // with the thread, which ends by itself if a disk hangs
  std::shared_ptr<Shared> shared_;
};

}  // namespace yuragi::daemon::http
