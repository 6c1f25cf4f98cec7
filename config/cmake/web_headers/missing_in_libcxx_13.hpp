#pragma once
// What the standard library of emscripten 3.1.6, libc++ 13, lacks of C++20, as far as the rooms need it that a browser
// runs. Every source includes this first. It goes when Debian's emscripten has libc++ 16.
#ifdef __cplusplus
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

static_assert(_LIBCPP_VERSION < 16000, "this library has them: remove this file");

// NOLINTBEGIN(cert-dcl58-cpp): the names are the standard's
namespace std::ranges {

struct kept_as_it_is {
  template <class T>
  constexpr T&& operator()(T&& value) const noexcept {
    return std::forward<T>(value);
  }
};

template <class R, class F, class P = kept_as_it_is>
constexpr auto find_if(R&& range, F is, P part = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& each) { return std::invoke(is, std::invoke(part, each)); });
}
template <class R, class T, class P = kept_as_it_is>
constexpr auto find(R&& range, const T& value, P part = {}) {
  return ranges::find_if(
      range, [&](auto&& each) { return each == value; }, part);
}
template <class R, class F, class P = kept_as_it_is>
constexpr bool any_of(R&& range, F is, P part = {}) {
  return ranges::find_if(range, is, part) != std::end(range);
}
template <class R, class F, class P = kept_as_it_is>
constexpr bool none_of(R&& range, F is, P part = {}) {
  return !ranges::any_of(range, is, part);
}
template <class R, class F, class P = kept_as_it_is>
constexpr bool all_of(R&& range, F is, P part = {}) {
  return ranges::none_of(
      range, [&](auto&& each) { return !std::invoke(is, each); }, part);
}
template <class R, class T, class P = kept_as_it_is>
constexpr auto count(R&& range, const T& value, P part = {}) {
  return std::count_if(std::begin(range), std::end(range),
                       [&](auto&& each) { return std::invoke(part, each) == value; });
}
template <class R, class C = std::less<>, class P = kept_as_it_is>
constexpr void sort(R&& range, C before = {}, P part = {}) {
  std::sort(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return std::invoke(before, std::invoke(part, a), std::invoke(part, b));
  });
}
template <class R, class C = std::less<>, class P = kept_as_it_is>
constexpr auto max_element(R&& range, C before = {}, P part = {}) {
  return std::max_element(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return std::invoke(before, std::invoke(part, a), std::invoke(part, b));
  });
}
template <class R, class T, class C = std::less<>, class P = kept_as_it_is>
constexpr auto lower_bound(R&& range, const T& value, C before = {}, P part = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value, [&](auto&& each, const auto& of) {
    return std::invoke(before, std::invoke(part, each), of);
  });
}
template <class R, class T, class C = std::less<>, class P = kept_as_it_is>
constexpr auto upper_bound(R&& range, const T& value, C before = {}, P part = {}) {
  return std::upper_bound(std::begin(range), std::end(range), value, [&](const auto& of, auto&& each) {
    return std::invoke(before, of, std::invoke(part, each));
  });
}
template <class A, class B, class F = std::equal_to<>, class P = kept_as_it_is, class Q = kept_as_it_is>
constexpr bool equal(A&& a, B&& b, F are = {}, P part_of_a = {}, Q part_of_b = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), [&](auto&& x, auto&& y) {
    return std::invoke(are, std::invoke(part_of_a, x), std::invoke(part_of_b, y));
  });
}
template <class R, class O>
constexpr void copy(R&& range, O to) {
  std::copy(std::begin(range), std::end(range), to);
}
template <class R, class T>
constexpr void fill(R&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class R, class O, class F>
constexpr void transform(R&& range, O to, F change) {
  std::transform(std::begin(range), std::end(range), to, [&](auto&& each) { return std::invoke(change, each); });
}
template <class R, class I>
constexpr void rotate(R&& range, I first) {
  std::rotate(std::begin(range), first, std::end(range));
}

}  // namespace std::ranges

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class T>
unique_ptr<T> make_unique_for_overwrite(size_t size) {
  return unique_ptr<T>(new remove_extent_t<T>[size]);
}

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  char* end = nullptr;
  const double number = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = number;
  return {first + (end - text.c_str()), errc{}};
}

/// The shortest text that gives the same number.
inline to_chars_result to_chars(char* first, char* last, double value) {
  constexpr int kMaxDigits = 17;
  char text[40];
  int size = 0;
  for (int digits = 1; digits <= kMaxDigits; ++digits) {
    size = snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, nullptr) == value) break;
  }
  if (last - first < size) return {last, errc::value_too_large};
  return {std::copy_n(text, size, first), errc{}};
}

}  // namespace std
// NOLINTEND(cert-dcl58-cpp)
#endif
