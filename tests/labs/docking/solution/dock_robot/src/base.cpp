#include <chrono>
#include <cmath>
#include <functional>
#include <memory>

#include "geometry_msgs/msg/transform_stamped.hpp"
#include "geometry_msgs/msg/twist.hpp"
#include "rclcpp/rclcpp.hpp"
#include "tf2_ros/transform_broadcaster.h"

using namespace std::chrono_literals;

class Base : public rclcpp::Node
{
public:
  Base()
  : Node("base")
  {
    x_ = declare_parameter("x", 0.0);
    y_ = declare_parameter("y", 0.0);
    broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
    subscription_ = create_subscription<geometry_msgs::msg::Twist>(
      "cmd_vel", 10, [this](geometry_msgs::msg::Twist::ConstSharedPtr message) {
        velocity_ = *message;
      });
    timer_ = create_wall_timer(50ms, std::bind(&Base::step, this));
  }

private:
  void step()
  {
    heading_ += 0.05 * velocity_.angular.z;
    x_ += 0.05 * velocity_.linear.x * std::cos(heading_);
    y_ += 0.05 * velocity_.linear.x * std::sin(heading_);
    geometry_msgs::msg::TransformStamped pose;
    pose.header.stamp = now();
    pose.header.frame_id = "odom";
    pose.child_frame_id = "base_link";
    pose.transform.translation.x = x_;
    pose.transform.translation.y = y_;
    pose.transform.rotation.z = std::sin(heading_ / 2);
    pose.transform.rotation.w = std::cos(heading_ / 2);
    broadcaster_->sendTransform(pose);
  }

  double x_, y_, heading_ = 0.0;
  geometry_msgs::msg::Twist velocity_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  rclcpp::Subscription<geometry_msgs::msg::Twist>::SharedPtr subscription_;
  rclcpp::TimerBase::SharedPtr timer_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Base>());
  rclcpp::shutdown();
  return 0;
}
