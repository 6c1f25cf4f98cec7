#include "daemon/tools/csv/csv_survey.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_fields.hpp"
#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_unit_choice.hpp"
#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// How the times of a file look in one format.
struct FormatTally {
  std::size_t count = 0;  ///< rows that have such a time
  std::size_t forward = 0;
  std::size_t back = 0;
  std::optional<UtcTime> last;
  std::optional<std::chrono::year> first_year;
  std::optional<std::chrono::year> last_year;
  std::size_t back_to_years = 0;
  std::size_t changes_of_year = 0;
  std::size_t back_in_year = 0;  ///< if all years were one
  Nanoseconds last_in_year{0};
  bool has_leap_day = false;

  void add(const std::optional<Time>& time) {
    if (!time) return;
    ++count;
    const UtcTime utc = time->clock - time->utc_offset.value_or(Nanoseconds{0});
    if (last && utc > *last) ++forward;
    if (last && utc < *last) ++back;
    last = utc;
    add_in_year(time->clock);
  }

  /// A typical year has each month from another year. Its last hour may end in the next year.
  bool is_typical_year() const {
    constexpr std::size_t kMaxChanges = 24;
    return back_to_years > 0 && back_in_year <= 1 && changes_of_year <= kMaxChanges;
  }

  /// The year of its first row, or the next one that has as many days.
  std::chrono::year typical_year() const {
    std::chrono::year year = *first_year;
    while (year.is_leap() != has_leap_day) ++year;
    return year;
  }

 private:
  void add_in_year(UtcTime clock) {
    const std::chrono::year_month_day ymd(std::chrono::floor<std::chrono::days>(clock));
    if (!first_year) first_year = ymd.year();
    if (last_year && ymd.year() < *last_year) ++back_to_years;
    if (last_year && ymd.year() != *last_year) ++changes_of_year;
    last_year = ymd.year();
    has_leap_day = has_leap_day || (ymd.month() == std::chrono::February && unsigned(ymd.day()) == 29);
    // In a leap year, so that the days of all years are in order.
    constexpr auto kLeapYear = std::chrono::year(2000);
    const auto day = std::chrono::sys_days(kLeapYear / ymd.month() / ymd.day());
    const Nanoseconds in_year =
        UtcTime(day) + (clock - std::chrono::sys_days(ymd)) - UtcTime(std::chrono::sys_days(kLeapYear / 1 / 1));
    if (count > 1 && in_year < last_in_year) ++back_in_year;
    last_in_year = in_year;
  }
};

/// Times that are numbers without a date, as seconds.
class SecondsTally {
 public:
  void add(std::string_view text) {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    constexpr std::int64_t kHundred = 100;
    constexpr std::int64_t kMinutes = 60;
    const auto ns = parse_decimal(text, 9);
    if (!ns) return;
    const std::int64_t whole = *ns / kSecond_ns;
    are_whole_ = are_whole_ && *ns % kSecond_ns == 0;
    is_past_minute_ = is_past_minute_ || whole % kHundred >= kMinutes;
    greatest_ = std::max(greatest_, whole);
    ++count_;
    const double step_ns = static_cast<double>(*ns) - static_cast<double>(last_.value_or(*ns));
    if (step_ns < 0.0 && drops_.size() < kMaxSteps) drops_.push_back(-step_ns);
    if (step_ns > 0.0 && steps_.size() < kMaxSteps) steps_.push_back(step_ns);
    last_ = *ns;
  }

  /// Why they are hardly seconds; nullopt if they may be.
  std::optional<std::string_view> doubt() {
    if (count_ < 3) return std::nullopt;
    if (steps_.empty()) return "they do not grow";
    const auto middle = steps_.begin() + static_cast<std::ptrdiff_t>(steps_.size() / 2);
    std::ranges::nth_element(steps_, middle);
    const double usual = *middle;
    // A clock that is put right goes back by little, one of hours or of the day begins again.
    constexpr double kManySteps = 5.0;
    constexpr std::int64_t kHours = 24;
    constexpr std::ptrdiff_t kOften = 3;
    const auto beginnings = std::ranges::count_if(drops_, [usual](double drop) { return drop > kManySteps * usual; });
    if (beginnings >= kOften || (beginnings > 0 && are_whole_ && greatest_ <= kHours)) return "they begin again";
    constexpr std::int64_t kFirstHour = 100;
    if (are_whole_ && greatest_ >= kFirstHour && !is_past_minute_)
      return "they look like hours and minutes (1359 and then 1400)";
    const auto even =
        std::ranges::count_if(steps_, [usual](double step) { return step > 0.5 * usual && step < 1.5 * usual; });
    constexpr std::size_t kMinSteps = 10;
    if (steps_.size() < kMinSteps) return std::nullopt;
    constexpr double kEven = 0.8;
    if (static_cast<double>(even) < kEven * static_cast<double>(steps_.size())) return "their steps are uneven";
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kMaxSteps = 10'000;
  std::vector<double> steps_;  ///< forward; the first ones
  std::vector<double> drops_;  ///< back
  std::optional<std::int64_t> last_;
  std::int64_t greatest_ = 0;
  std::size_t count_ = 0;
  bool are_whole_ = true;
  bool is_past_minute_ = false;
};

/// The greatest numbers of a column.
struct NumberTally {
  std::optional<double> greatest;
  std::size_t times = 0;  ///< that the greatest comes
  std::optional<double> next;

  void add(double value) {
    if (!greatest || value > *greatest) {
      next = greatest;
      greatest = value;
      times = 1;
    } else if (value == *greatest) {
      ++times;
    } else if (!next || value > *next) {
      next = value;
    }
  }

  bool is_far_above_others() const {
    constexpr double kFar = 0.75;
    return next && *next < kFar * *greatest;
  }
};

/// Above this median a wind in m/s is a storm all the time.
constexpr double kStrangeMedian_m_s = 12.0;
/// A single value above this, far above all others, is not a value.
constexpr double kStrangeSpeed_m_s = 60.0;

class Surveyor {
 public:
  Surveyor(const Layout& layout, const ImportOptions& options) : layout_(layout), options_(options) {}

  void add(const Fields& fields) {
    add_time(fields.time);
    const auto speed = add_number(fields, Role::kSpeed);
    const auto gust = add_number(fields, Role::kGust);
    if (speed && *speed > 0.0) {
      ++moving_;
      if (*speed > kStrangeMedian_m_s) ++strong_;
    }
    if (speed && gust && *speed > 1.0) {
      constexpr double kRounding = 0.95;
      ++gusty_;
      if (*gust < kRounding * *speed) ++weak_gusts_;
    }
    add_number(fields, Role::kU);
    add_number(fields, Role::kV);
    for (const Role role : kQuantityRoles) add_number(fields, role);
  }

  Result<Survey, Failure> finish() {
    if (const auto done = settle_time(); !done) return done.error();
    settle_marks();
    if (const auto done = check_units(); !done) return done.error();
    return std::move(result_);
  }

 private:
  FormatTally& tally(TimeFormat format) { return formats_[static_cast<std::size_t>(format)]; }

  void add_time(std::string_view text) {
    if (options_.time_format != TimeFormat::kAuto) {
      tally(options_.time_format).add(parse_time(text, options_.time_format));
      return;
    }
    if (const auto count_format = guess_count_format(text)) {
      ++numbers_;
      if (!number_format_) number_format_ = is_in_ms() ? TimeFormat::kUnixMs : *count_format;
      tally(*number_format_).add(parse_time(text, *number_format_));
      if (*number_format_ == TimeFormat::kSeconds) seconds_.add(text);
      tally(TimeFormat::kCompact).add(parse_time(text, TimeFormat::kCompact));
      return;
    }
    tally(TimeFormat::kIso).add(parse_time(text, TimeFormat::kIso));
    // No day and no month has three digits.
    constexpr std::size_t kDigitsOfYear = 3;
    if (std::min(text.find_first_not_of("0123456789"), text.size()) >= kDigitsOfYear) return;
    const auto day_first = parse_time(text, TimeFormat::kDayFirst);
    const auto month_first = parse_time(text, TimeFormat::kMonthFirst);
    tally(TimeFormat::kDayFirst).add(day_first);
    tally(TimeFormat::kMonthFirst).add(month_first);
    if (day_first && month_first && day_first->clock != month_first->clock && ambiguous_.empty()) ambiguous_ = text;
    if (text.size() > 5 && text.substr(0, 6).find('.') != std::string_view::npos) ++dotted_;
  }

  /// By the name of the column, or its row of units. The program's own exports have further times.
  bool are_named_seconds() const {
    const auto& column = *layout_.columns.at(Role::kTime);
    if (column.unit || layout_.columns.at(Role::kElapsed)) return true;
    return std::ranges::any_of(words_of(column.name), [](const std::string& word) {
      return word == "s" || word == "sec" || word == "secs" || word == "seconds" || word == "elapsed" ||
             word == "uptime";
    });
  }

  bool is_in_ms() const {
    const auto& column = layout_.columns.at(Role::kTime);
    return column && column->unit && column->unit->name == "ms";
  }

  /// The number of a field in its base unit, unless it is missing.
  std::optional<double> add_number(const Fields& fields, Role role) {
    const auto& text = fields.at(role);
    if (!text || is_missing_word(*text)) return std::nullopt;
    const auto number = parse_number(*text, dimension_of(role));
    if (!number) return std::nullopt;
    const Unit unit = number->unit.value_or(layout_.columns.at(role)->unit.value_or(Unit{}));
    const double base = in_base(unit, number->value);
    if (is_missing_number(role, number->value, base)) return std::nullopt;
    numbers_of_[static_cast<std::size_t>(role)].add(number->value);
    if (is_possible_mark(role, number->value)) return std::nullopt;
    return base;
  }

  Result<void, Failure> settle_time() {
    if (options_.time_format != TimeFormat::kAuto) return settle_as(options_.time_format);
    const auto count = [this](TimeFormat format) { return tally(format).count; };
    const std::size_t dates =
        std::max({count(TimeFormat::kIso), count(TimeFormat::kDayFirst), count(TimeFormat::kMonthFirst)});
    if (numbers_ > dates) {
      const std::string name = lower(layout_.columns.at(Role::kTime)->name);
      const bool is_unix = name.find("unix") != std::string::npos || name.find("epoch") != std::string::npos;
      const bool is_compact = !is_unix && !is_in_ms() && count(TimeFormat::kCompact) == numbers_;
      if (!is_compact && *number_format_ == TimeFormat::kSeconds && !are_named_seconds()) {
        if (const auto doubt = seconds_.doubt()) {
          return Failure{
              fmt::format("the times in \"{}\" are numbers without a date, and no seconds, because {}; name the "
                          "columns with --date and --time, or add --time-format seconds if they are seconds",
                          layout_.columns.at(Role::kTime)->name, *doubt)};
        }
      }
      return settle_as(is_compact ? TimeFormat::kCompact : *number_format_);
    }
    if (dates == 0 || count(TimeFormat::kIso) == dates) return settle_as(TimeFormat::kIso);
    if (layout_.columns.is_day_first) {
      return settle_as(*layout_.columns.is_day_first ? TimeFormat::kDayFirst : TimeFormat::kMonthFirst);
    }
    return settle_order_of_date();
  }

  Result<void, Failure> settle_as(TimeFormat format) {
    result_.time_format = format;
    const FormatTally& times = tally(format);
    result_.is_newest_first = times.back >= 2 && times.back > 4 * times.forward;
    if (is_calendar(format) && times.is_typical_year()) {
      result_.typical_year = times.typical_year();
      result_.notes.push_back(fmt::format("a typical year, whose months are of different years: all are put on {}",
                                          static_cast<int>(*result_.typical_year)));
    }
    return {};
  }

  /// Of dates like 3/4/2023.
  Result<void, Failure> settle_order_of_date() {
    const FormatTally& day_first = tally(TimeFormat::kDayFirst);
    const FormatTally& month_first = tally(TimeFormat::kMonthFirst);
    if (ambiguous_.empty() && day_first.count == month_first.count) return settle_as(TimeFormat::kDayFirst);
    if (day_first.count != month_first.count) {
      const bool is_day_first = day_first.count > month_first.count;
      result_.notes.push_back(fmt::format("dates: the {} comes first, because a number above 12 is in its place",
                                          is_day_first ? "day" : "month"));
      return settle_as(is_day_first ? TimeFormat::kDayFirst : TimeFormat::kMonthFirst);
    }
    if (dotted_ == day_first.count) {
      result_.notes.emplace_back("dates: the day comes first, because dots separate the numbers");
      return settle_as(TimeFormat::kDayFirst);
    }
    if ((day_first.back == 0) != (month_first.back == 0)) {
      const bool is_day_first = day_first.back == 0;
      result_.notes.push_back(fmt::format("dates: the {} comes first, because times would go back otherwise",
                                          is_day_first ? "day" : "month"));
      return settle_as(is_day_first ? TimeFormat::kDayFirst : TimeFormat::kMonthFirst);
    }
    return Failure{"the order of day and month is not clear in \"" + ambiguous_ +
                   "\", nor in any other row; add --time-format day-first or month-first"};
  }

  void settle_marks() {
    for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
      const auto role = static_cast<Role>(index);
      const NumberTally& numbers = numbers_of_[index];
      if (!numbers.greatest || !is_possible_mark(role, *numbers.greatest)) continue;
      const Column& column = *layout_.columns.at(role);
      const bool is_storm = dimension_of(role) == Dimension::kSpeed && column.unit &&
                            in_base(*column.unit, *numbers.greatest) > kStrangeSpeed_m_s;
      if (numbers.is_far_above_others() && (numbers.times > 1 || is_storm)) {
        result_.missing_mark[index] = numbers.greatest;
        result_.notes.push_back(fmt::format(
            "{} in \"{}\" is treated as a missing value: it occurs {} and is far above all others (the next is {})",
            *numbers.greatest, column.name, numbers.times == 1 ? "once" : fmt::format("{} times", numbers.times),
            *numbers.next));
      } else {
        result_.notes.push_back(
            fmt::format("{} in \"{}\" is used as a value; if it marks a missing value, add --missing {}",
                        *numbers.greatest, column.name, *numbers.greatest));
      }
    }
  }

  Result<void, Failure> check_units() {
    const auto& speed = layout_.columns.at(Role::kSpeed);
    if (speed && speed->unit_source == kAssumedUnit) {
      constexpr const char* kSayUnit = "add --unit with m/s, km/h, kn, mph or ft/s";
      if (2 * strong_ > moving_) {
        return Failure{
            fmt::format("no unit is given for column \"{}\", and in m/s most of its rows would be above {} m/s; {}",
                        speed->name, kStrangeMedian_m_s, kSayUnit)};
      }
      for (const Role role : {Role::kTemperature, Role::kPressure}) {
        const auto& other = layout_.columns.at(role);
        if (!other || (other->unit->name != "F" && other->unit->name != "inHg")) continue;
        return Failure{fmt::format("no unit is given for column \"{}\", and \"{}\" is in {}; {}", speed->name,
                                   other->name, other->unit->name, kSayUnit)};
      }
    }
    if (gusty_ < 3 || 2 * weak_gusts_ <= gusty_) return {};
    const Column& gust = *layout_.columns.at(Role::kGust);
    const std::string found =
        fmt::format("in {} of {} rows the gust would be below the speed (\"{}\" in {}, \"{}\" in {})", weak_gusts_,
                    gusty_, gust.name, gust.unit->name, speed->name, speed->unit->name);
    if (gust.unit_source.starts_with("by ")) {
      result_.notes.push_back(found);
      return {};
    }
    return Failure{found + "; add --gust-unit and --unit"};
  }

  const Layout& layout_;
  const ImportOptions& options_;
  std::array<FormatTally, kCsvTimeFormatCount> formats_;
  std::size_t numbers_ = 0;  ///< times that are numbers
  std::optional<TimeFormat> number_format_;
  SecondsTally seconds_;
  std::string ambiguous_;  ///< the first date that can be read either way
  std::size_t dotted_ = 0;
  std::array<NumberTally, kCsvRoleCount> numbers_of_;
  std::size_t moving_ = 0;  ///< rows with a speed above 0
  std::size_t strong_ = 0;
  std::size_t gusty_ = 0;  ///< rows with both speed and gust
  std::size_t weak_gusts_ = 0;
  Survey result_;
};

}  // namespace

Result<Survey, Failure> survey_rows(std::istream& in, const Layout& layout, const ImportOptions& options) {
  auto splitter = RowSplitter::make(layout, options);
  if (!splitter) return splitter.error();
  Lines lines(in, options.comment);
  lines.begin_at(layout.first_row);
  Surveyor survey(layout, options);
  Fields fields;
  while (lines.next()) {
    const auto is_row = splitter->split(lines.line(), fields);
    if (is_row && *is_row) survey.add(fields);
  }
  return survey.finish();
}

}  // namespace yuragi::daemon::tools::csv
