#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "rclcpp/rclcpp.hpp"
#include "trajectory_msgs/msg/joint_trajectory.hpp"
#include "trajectory_msgs/msg/joint_trajectory_point.hpp"

// Sends the arm to one pose after the other.
class PoseSender : public rclcpp::Node
{
public:
  PoseSender()
  : Node("pose_sender")
  {
    joints_ = declare_parameter("joints", std::vector<std::string>{});
    poses_ = declare_parameter("poses", std::vector<double>{});
    period_ = declare_parameter("period", 5.0);
    publisher_ = create_publisher<trajectory_msgs::msg::JointTrajectory>("arm_controller/joint_trajectory", 10);
    timer_ = create_wall_timer(std::chrono::duration<double>(period_), [this] {send();});
  }

private:
  void send()
  {
    if (joints_.empty() || poses_.size() < joints_.size()) {
      return;
    }
    trajectory_msgs::msg::JointTrajectoryPoint point;
    for (size_t i = 0; i < joints_.size(); ++i) {
      point.positions.push_back(poses_[(next_ + i) % poses_.size()]);
    }
    point.time_from_start = rclcpp::Duration::from_seconds(0.8 * period_);
    next_ = (next_ + joints_.size()) % poses_.size();

    trajectory_msgs::msg::JointTrajectory trajectory;
    trajectory.joint_names = joints_;
    trajectory.points.push_back(point);
    publisher_->publish(trajectory);
  }

  std::vector<std::string> joints_;
  std::vector<double> poses_;
  double period_;
  size_t next_ = 0;
  rclcpp::Publisher<trajectory_msgs::msg::JointTrajectory>::SharedPtr publisher_;
  rclcpp::TimerBase::SharedPtr timer_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<PoseSender>());
  rclcpp::shutdown();
  return 0;
}
