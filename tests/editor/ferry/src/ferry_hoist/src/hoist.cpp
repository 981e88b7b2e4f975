#include <memory>
#include "ferry_hoist/limits.hpp"
#include "ferry_msgs/action/lift.hpp"
#include "ferry_msgs/msg/load.hpp"
#include "ferry_msgs/srv/tare.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "sensor_msgs/msg/range.hpp"
#include "std_msgs/msg/bool.hpp"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"

class Hoist : public rclcpp::Node
{
public:
  Hoist()
  : Node("hoist"), buffer_(get_clock()), listener_(buffer_)
  {
    declare_parameter("max_height", 1.2);
    declare_parameter("winch_speed", 0.1);
    load_ = create_subscription<ferry_msgs::msg::Load>(
      "load", 10, [this](const ferry_msgs::msg::Load & load) {on_load(load);});
    height_ = create_publisher<sensor_msgs::msg::Range>("hook_height", 10);
    tare_ = create_client<ferry_msgs::srv::Tare>("tare");
  }

private:
  void on_load(const ferry_msgs::msg::Load & load)
  {
    const auto place = buffer_.lookupTransform("base_link", "hook_link", tf2::TimePointZero);
    sensor_msgs::msg::Range range;
    range.header.frame_id = "hook_link";
    range.range = place.transform.translation.z;
    range.max_range = get_parameter("max_height").as_double();
    if (load.mass < MAX_MASS) {
      height_->publish(range);
    }
  }
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  rclcpp::Subscription<ferry_msgs::msg::Load>::SharedPtr load_;
  rclcpp::Publisher<sensor_msgs::msg::Range>::SharedPtr height_;
  rclcpp::Client<ferry_msgs::srv::Tare>::SharedPtr tare_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Hoist>());
  rclcpp::shutdown();
  return 0;
}
