#pragma once

#include <string>

namespace yuragi::daemon::tools::calibration {

class Report;

/// Leads a person through a calibration: steps and results on standard output, live values on standard error. If
/// there is no person (no terminal, or --yes), it never waits.
class Dialog {
 public:
  /// `takes_yes`: every confirm() is true, and wait_until_prepared() does not wait. `report`: there is no person, and
  /// it gets what is printed; nullptr: standard output does.
  explicit Dialog(bool takes_yes, Report* report = nullptr);

  /// Returns true if there is a person at the terminal.
  bool has_person() const noexcept { return has_person_; }

  /// Prints a paragraph.
  void print(const std::string& text) const;

  /// Prints what a person has to prepare, and waits for Enter.
  void wait_until_prepared(const std::string& what) const;

  /// Prompts for a number until one within the range is given. Precondition: has_person().
  double prompt_number(const std::string& question, double least, double most) const;

  /// Asks whether to go on; Enter alone means no. Without a person: `takes_yes`.
  bool confirm(const std::string& question) const;

  /// Live values: in one place on a terminal, elsewhere a line every few seconds. The last one stays.
  void show(double elapsed_s, const std::string& values, bool is_last);

 private:
  Report* report_;
  bool takes_yes_;
  bool has_person_;
  bool is_watched_;
  double next_line_s_ = 0.0;
};

}  // namespace yuragi::daemon::tools::calibration
