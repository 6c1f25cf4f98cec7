#pragma once

namespace yuragi::wind {

/// Horizontal wind toward which the air moves: u east, v north, m/s. Averages and blends use these, never degrees, so
/// that there is no problem at 360.
struct Vector {
  double u_m_s = 0.0;
  double v_m_s = 0.0;

  template <class Pass>
  void list_state(Pass& pass) {
    pass(u_m_s, v_m_s);
  }

  friend Vector operator+(Vector a, Vector b) { return {a.u_m_s + b.u_m_s, a.v_m_s + b.v_m_s}; }
  friend Vector operator-(Vector a, Vector b) { return {a.u_m_s - b.u_m_s, a.v_m_s - b.v_m_s}; }
  friend Vector operator*(double k, Vector a) { return {k * a.u_m_s, k * a.v_m_s}; }
  friend double dot(Vector a, Vector b) noexcept { return a.u_m_s * b.u_m_s + a.v_m_s * b.v_m_s; }
};

/// Speed, m/s.
double speed_of(Vector wind) noexcept;

/// Where the wind comes from, degrees clockwise from north, [0, 360). 0 for no wind.
double direction_from_deg(Vector wind) noexcept;

/// The vector of a wind that comes from `direction_deg`.
Vector wind_from(double speed_m_s, double direction_deg) noexcept;

}  // namespace yuragi::wind
