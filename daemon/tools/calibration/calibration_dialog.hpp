#pragma once

#include <string>

namespace yuragi {

/// Leads a person through a calibration: steps and results on standard output, live values on standard error. Where
/// nobody can be asked (no terminal, or --yes) it never waits.
class CalibrationDialog {
 public:
  /// `takes_yes`: every question is answered with yes, and hands are taken to be ready.
  explicit CalibrationDialog(bool takes_yes);

  /// Is there somebody to ask?
  bool has_person() const noexcept { return has_person_; }

  /// A paragraph.
  void print(const std::string& text) const;

  /// What hands are needed for; then waits for Enter.
  void wait_until_prepared(const std::string& what) const;

  /// Asks for a number within a range, again and again. Only where there is somebody.
  double prompt_number(const std::string& question, double least, double most) const;

  /// Asks whether to go on: Enter alone is no. Without a person it is what was given beforehand.
  bool confirm(const std::string& question) const;

  /// Live values: in one place on a terminal, elsewhere a line every few seconds. The last one stays.
  void show(double elapsed_s, const std::string& values, bool is_last);

 private:
  bool takes_yes_;
  bool has_person_;
  bool is_watched_;
  double next_line_s_ = 0.0;
};

}  // namespace yuragi
