#include "tests/answer/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/units.hpp"

namespace yuragi::answer {

double Horizontal::length() const {
  return std::hypot(east, south);
}

Horizontal Horizontal::unit() const {
  const double all = length();
  return all > 0.0 ? Horizontal{east / all, south / all} : Horizontal{0.0, 1.0};
}

JointTracks::JointTracks(std::vector<std::size_t> joints) : joints_(std::move(joints)) {
  for (auto& axis : axes_m_) axis.resize(joints_.size());
}

void JointTracks::take(const pose::Kinematics& joints) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const pose::JointPosition place = joints.joint(joints_[i]);
    axes_m_[0][i].push_back(place.x_m);
    axes_m_[1][i].push_back(place.y_m);
    axes_m_[2][i].push_back(place.z_m);
  }
}

Series JointTracks::way_m(std::size_t from, std::size_t to, Horizontal along) const {
  Series way(x_m(to).size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Horizontal all{static_cast<double>(x_m(to)[i]) - static_cast<double>(x_m(from)[i]),
                         static_cast<double>(z_m(to)[i]) - static_cast<double>(z_m(from)[i])};
    way[i] = static_cast<float>(all.dot(along));
  }
  return way;
}

Horizontal JointTracks::mean_way_m(std::size_t from, std::size_t to) const {
  return {mean(x_m(to)) - mean(x_m(from)), mean(z_m(to)) - mean(z_m(from))};
}

Series JointTracks::angle_from_down_deg(std::size_t from, std::size_t to) const {
  Series angle(x_m(to).size());
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const double across_m = std::hypot(static_cast<double>(x_m(to)[i]) - static_cast<double>(x_m(from)[i]),
                                       static_cast<double>(z_m(to)[i]) - static_cast<double>(z_m(from)[i]));
    const double down_m = static_cast<double>(y_m(from)[i]) - static_cast<double>(y_m(to)[i]);
    angle[i] = static_cast<float>(std::atan2(across_m, down_m) / kRadPerDeg);
  }
  return angle;
}

double JointTracks::speed_m_s(std::size_t joint, double rate_hz) const {
  double sum = 0.0;
  const std::size_t count = x_m(joint).size();
  if (count < 2) return 0.0;
  for (const auto& axis : axes_m_) {
    const Series& place_m = axis[joint];
    for (std::size_t i = 1; i < count; ++i) {
      const double step_m = static_cast<double>(place_m[i]) - static_cast<double>(place_m[i - 1]);
      sum += step_m * step_m;
    }
  }
  return rate_hz * std::sqrt(sum / static_cast<double>(count - 1));
}

double JointTracks::largest_step_m() const {
  double largest_m2 = 0.0;
  for (std::size_t joint = 0; joint < count(); ++joint) {
    for (std::size_t i = 1; i < x_m(joint).size(); ++i) {
      double step_m2 = 0.0;
      for (const auto& axis : axes_m_) {
        const double step_m = static_cast<double>(axis[joint][i]) - static_cast<double>(axis[joint][i - 1]);
        step_m2 += step_m * step_m;
      }
      largest_m2 = std::max(largest_m2, step_m2);
    }
  }
  return std::sqrt(largest_m2);
}

BendTracks::BendTracks(std::vector<std::size_t> strands, std::size_t level)
    : strands_(std::move(strands)), level_(level), east_deg_(strands_.size()), south_deg_(strands_.size()) {}

void BendTracks::take(const pose::Pose& pose) {
  const auto* tree = std::get_if<pose::TreePose>(&pose);
  const pose::StrandPose& bends = tree != nullptr ? tree->levels[level_] : std::get<pose::StrandPose>(pose);
  constexpr auto kDegPerRad = static_cast<float>(1.0 / kRadPerDeg);
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    east_deg_[i].push_back(kDegPerRad * bends.bend_east_rad[strands_[i]]);
    south_deg_[i].push_back(kDegPerRad * bends.bend_south_rad[strands_[i]]);
  }
}

std::vector<Series> BendTracks::along_deg(Horizontal unit) const {
  std::vector<Series> along(count());
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t k = 0; k < east_deg_[i].size(); ++k) {
      const Horizontal bend{static_cast<double>(east_deg_[i][k]), static_cast<double>(south_deg_[i][k])};
      along[i].push_back(static_cast<float>(bend.dot(unit)));
    }
  }
  return along;
}

std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> numbers;
  const std::size_t taken = std::min(count, most);
  for (std::size_t i = 0; i < taken; ++i) numbers.push_back(taken < 2 ? 0 : i * (count - 1) / (taken - 1));
  return numbers;
}

Series mean_at_each_moment(const std::vector<Series>& series) {
  Series means(series.empty() ? 0 : series.front().size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    double sum = 0.0;
    for (const Series& one : series) sum += static_cast<double>(one[k]);
    means[k] = static_cast<float>(sum / static_cast<double>(series.size()));
  }
  return means;
}

double difference_at_one_moment(const std::vector<Series>& series) {
  if (series.empty() || series.front().empty()) return 0.0;
  const std::size_t moments = series.front().size();
  std::vector<double> sum(moments, 0.0);
  std::vector<double> square(moments, 0.0);
  for (const Series& one : series) {
    const double own = mean(one);
    for (std::size_t k = 0; k < moments; ++k) {
      const double off = static_cast<double>(one[k]) - own;
      sum[k] += off;
      square[k] += off * off;
    }
  }
  const auto count = static_cast<double>(series.size());
  double all = 0.0;
  for (std::size_t k = 0; k < moments; ++k) all += square[k] / count - (sum[k] / count) * (sum[k] / count);
  return std::sqrt(std::max(all, 0.0) / static_cast<double>(moments));
}

}  // namespace yuragi::answer
