#include "daemon/web/problem.hpp"

#include <nlohmann/json.hpp>

namespace yuragi::daemon::web {

HttpResponse problem(unsigned status, std::string title, std::string detail) {
  const nlohmann::ordered_json json = {
      {"type", "about:blank"}, {"title", std::move(title)}, {"status", status}, {"detail", std::move(detail)}};
  // The detail may quote what was asked, whatever bytes that had.
  return {.status = status,
          .content_type = "application/problem+json",
          .body = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"};
}

}  // namespace yuragi::daemon::web
