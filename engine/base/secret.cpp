#include "engine/base/secret.hpp"

namespace yuragi {

// The authority of a URI: [userinfo "@"] host [":" port], up to the first of / ? # (T. Berners-Lee, R. Fielding and
// L. Masinter, RFC 3986, "Uniform Resource Identifier (URI): Generic Syntax", 2005, section 3.2).
bool holds_credentials(std::string_view text) noexcept {
  const std::size_t scheme_end = text.find("://");
  const bool is_url = scheme_end != std::string_view::npos;
  if (is_url) text.remove_prefix(scheme_end + 3);
  const std::string_view authority = text.substr(0, text.find_first_of("/?#"));
  const std::size_t at = authority.rfind('@');
  if (at == std::string_view::npos) return false;
  // Without a scheme the credentials must be the whole text, because "@" and ":" also occur in other texts.
  const bool is_whole = authority.size() == text.size() && authority.find_first_of(" \t") == std::string_view::npos;
  return authority.substr(0, at).find(':') != std::string_view::npos && (is_url || is_whole);
}

}  // namespace yuragi
