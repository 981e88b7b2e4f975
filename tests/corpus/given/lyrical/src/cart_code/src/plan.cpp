#include <nav_msgs/msg/trajectory.hpp>
#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("plan");
  auto paths = node->create_publisher<nav_msgs::msg::Trajectory>("plan", 10);
  rclcpp::spin(node);
  rclcpp::shutdown();
  return 0;
}
