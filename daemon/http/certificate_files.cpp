#include "daemon/http/certificate_files.hpp"

#include <ctime>
#include <mutex>
#include <thread>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/context.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/asn1.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include "engine/base/contain.hpp"
#include "engine/base/result.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::http {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;
using std::chrono::system_clock;

constexpr std::size_t kMaxFile_bytes = 256UL * 1024;

struct Certificate {
  std::shared_ptr<ssl::context> context;
  system_clock::time_point valid_until;
};

/// Returns the end of the validity of the certificate in a context; nullopt if there is none.
std::optional<system_clock::time_point> end_of(ssl::context& context) {
  const X509* const certificate = SSL_CTX_get0_certificate(context.native_handle());
  std::tm end{};
  if (certificate == nullptr || ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end) != 1) return std::nullopt;
  return system_clock::from_time_t(timegm(&end));
}

std::string day_of(system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(system_clock::to_time_t(time)));
}

Result<Certificate, Failure> read(const std::filesystem::path& certificate, const std::filesystem::path& key) {
  const auto fail = [](const char* name, const std::filesystem::path& file, const std::string& why) {
    return Failure{fmt::format("[http] {}: \"{}\" {}", name, file.string(), why), FailureKind::kUnavailable};
  };
  const auto certificate_text = platform::read_whole(certificate, kMaxFile_bytes);
  if (!certificate_text) return fail("certificate", certificate, certificate_text.error().message);
  if (key.empty())
    return Failure{"[http] key: is missing: name the file with the key of the certificate", FailureKind::kUnavailable};
  const auto key_text = platform::read_whole(key, kMaxFile_bytes);
  if (!key_text) return fail("key", key, key_text.error().message);

  const auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  context->set_options(ssl::context::default_workarounds | ssl::context::no_sslv2 | ssl::context::no_sslv3 |
                       ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1);
  error_code error;
  // OpenSSL would ask the daemon's terminal.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
  context->use_certificate_chain(boost::asio::buffer(*certificate_text), error);
  if (error) return fail("certificate", certificate, "is not a certificate as PEM");
  context->use_private_key(boost::asio::buffer(*key_text), ssl::context::pem, error);
  const bool fits = !error && SSL_CTX_check_private_key(context->native_handle()) == 1;
  if (error && ERR_GET_REASON(static_cast<unsigned long>(error.value())) == X509_R_KEY_VALUES_MISMATCH)
    return fail("key", key, "is not the key of " + certificate.string());
  if (error) return fail("key", key, "is not a private key as PEM without a password");
  if (!fits) return fail("key", key, "is not the key of " + certificate.string());
  const auto end = end_of(*context);
  if (!end) return fail("certificate", certificate, "has no end of validity");
  if (*end <= system_clock::now()) return fail("certificate", certificate, "expired on " + day_of(*end) + "; renew it");
  return Certificate{context, *end};
}

}  // namespace

struct CertificateFiles::Shared {
  std::filesystem::path certificate, key;
  mutable std::mutex mutex;
  Certificate newest;       ///< of mutex
  std::string why_not_new;  ///< of mutex; empty: the files are in use
};

CertificateFiles::CertificateFiles(std::filesystem::path certificate, std::filesystem::path key)
    : shared_(std::make_shared<Shared>()) {
  shared_->newest = read(certificate, key).value();
  shared_->certificate = std::move(certificate);
  shared_->key = std::move(key);
}

std::shared_ptr<ssl::context> CertificateFiles::context() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->newest.context;
}

void CertificateFiles::read_again() {
  std::thread([shared = shared_] {
    contain("reading the certificate", [&] {
      auto read_now = read(shared->certificate, shared->key);
      const std::lock_guard lock(shared->mutex);
      shared->why_not_new = read_now ? std::string() : read_now.error().message;
      if (read_now) shared->newest = std::move(*read_now);
    });
  }).detach();
}

std::optional<std::string> CertificateFiles::trouble(system_clock::time_point now) const {
  const std::lock_guard lock(shared_->mutex);
  const auto end = shared_->newest.valid_until;
  if (!shared_->why_not_new.empty()) return shared_->why_not_new + "; the one before is used until " + day_of(end);
  if (now + kExpiresSoon < end) return std::nullopt;
  return fmt::format("[http] certificate: \"{}\" {} on {}; renew it", shared_->certificate.string(),
                     now < end ? "expires" : "expired", day_of(end));
}

}  // namespace yuragi::daemon::http
