#include <memory>

#include "cart_msgs/msg/obstacle.hpp"
#include "rclcpp/rclcpp.hpp"
#include "tf2/exceptions.h"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"

class Watch : public rclcpp::Node
{
public:
  Watch() : Node("watch"), buffer_(get_clock()), listener_(buffer_)
  {
    declare_parameter("limit", 1.0);
    subscription_ = create_subscription<cart_msgs::msg::Obstacle>(
      "obstacle", 10, [this](const cart_msgs::msg::Obstacle & obstacle) { look(obstacle); });
  }

private:
  void look(const cart_msgs::msg::Obstacle & obstacle)
  {
    if (obstacle.distance > get_parameter("limit").as_double()) {
      return;
    }
    try {
      auto transform = buffer_.lookupTransform("base_link", "lidar_link", tf2::TimePointZero);
      RCLCPP_INFO(get_logger(), "obstacle %f m ahead", transform.transform.translation.x);
    } catch (const tf2::TransformException & error) {
      RCLCPP_WARN(get_logger(), "%s", error.what());
    }
  }

  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  rclcpp::Subscription<cart_msgs::msg::Obstacle>::SharedPtr subscription_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Watch>());
  rclcpp::shutdown();
  return 0;
}
