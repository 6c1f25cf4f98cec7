#include "tests/answer/wind_record.hpp"

#include <cmath>

namespace yuragi::answer {

void WindRecord::take(wind::Vector wind) {
  east_m_s_.push_back(static_cast<float>(wind.u_m_s));
  south_m_s_.push_back(static_cast<float>(-wind.v_m_s));
}

Series WindRecord::squared_speed_m2_s2() const {
  Series squares(east_m_s_.size());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    squares[i] = east_m_s_[i] * east_m_s_[i] + south_m_s_[i] * south_m_s_[i];
  }
  return squares;
}

Series WindRecord::speed_m_s() const {
  Series speeds = squared_speed_m2_s2();
  for (float& speed : speeds) speed = std::sqrt(speed);
  return speeds;
}

double WindRecord::mean_speed_m_s() const {
  return mean(speed_m_s());
}

Horizontal WindRecord::downwind() const {
  return Horizontal{mean(east_m_s_), mean(south_m_s_)}.unit();
}

double WindRecord::intensity() const {
  const Horizontal ahead = downwind();
  Series along(east_m_s_.size());
  for (std::size_t i = 0; i < along.size(); ++i) {
    along[i] = static_cast<float>(ahead.dot({static_cast<double>(east_m_s_[i]), static_cast<double>(south_m_s_[i])}));
  }
  const double middle = mean(along);
  return middle > 0.0 ? deviation(along) / middle : 0.0;
}

double WindRecord::answer_of(const Series& figure) const {
  return correlation(running_mean(figure, kAnswerTicks), running_mean(squared_speed_m2_s2(), kAnswerTicks));
}

}  // namespace yuragi::answer
