#include "viewer/film/film_progress.hpp"

#include <cmath>

#include <fmt/format.h>

namespace yuragi::viewer::film {
namespace {

constexpr double kLongest_s = 1000.0 * 3600.0;

/// "0:07", "3:49", "12:03:49".
std::string clock_text(double duration_s) {
  const long long all_s = std::llround(duration_s);
  if (all_s < 3600) return fmt::format("{}:{:02}", all_s / 60, all_s % 60);
  return fmt::format("{}:{:02}:{:02}", all_s / 3600, all_s / 60 % 60, all_s % 60);
}

}  // namespace

std::string film_progress_text(int made, std::optional<int> total, double passed_s) {
  std::string text = fmt::format("picture {}", made);
  if (total) text += fmt::format(" of {}", *total);
  if (made == 0 || !(passed_s > 0.0)) return text;
  const double each_s = passed_s / made;
  text += each_s < 1.0 ? fmt::format(", {:.1f} a second", 1.0 / each_s) : fmt::format(", {:.1f} s each", each_s);
  if (!total) return text;
  const double left_s = each_s * (*total - made);
  return left_s < kLongest_s ? text + ", " + clock_text(left_s) + " left" : text;
}

}  // namespace yuragi::viewer::film
