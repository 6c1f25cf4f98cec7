#include "daemon/web/problem.hpp"

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {

http::Response problem(unsigned status, std::string title, std::string detail) {
  const nlohmann::ordered_json json = {
      {"type", "about:blank"}, {"title", std::move(title)}, {"status", status}, {"detail", std::move(detail)}};
  return {.status = status, .content_type = "application/problem+json", .body = json_text(json) + "\n"};
}

}  // namespace yuragi::daemon::web
