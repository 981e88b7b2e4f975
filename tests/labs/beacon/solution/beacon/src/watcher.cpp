#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "geometry_msgs/msg/point_stamped.hpp"
#include "geometry_msgs/msg/transform_stamped.hpp"
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/float64.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "tf2/exceptions.h"
#include "tf2/time.h"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"

using namespace std::chrono_literals;

class Watcher : public rclcpp::Node
{
public:
  Watcher()
  : Node("watcher")
  {
    declare_parameter("limit", 6.0);
    declare_parameter("frame_id", "world");

    buffer_ = std::make_unique<tf2_ros::Buffer>(get_clock());
    listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
    publisher_ = create_publisher<geometry_msgs::msg::PointStamped>("lamp_position", 10);
    subscription_ = create_subscription<std_msgs::msg::Float64>(
      "angle", rclcpp::SensorDataQoS(),
      std::bind(&Watcher::compare, this, std::placeholders::_1));
    client_ = create_client<std_srvs::srv::Trigger>("reset");
    timer_ = create_wall_timer(100ms, std::bind(&Watcher::look, this));
  }

private:
  void look()
  {
    geometry_msgs::msg::TransformStamped transform;
    try {
      transform = buffer_->lookupTransform(
        get_parameter("frame_id").as_string(), "lamp_link", tf2::TimePointZero);
    } catch (const tf2::TransformException & error) {
      RCLCPP_INFO(get_logger(), "no transform: %s", error.what());
      return;
    }
    geometry_msgs::msg::PointStamped point;
    point.header = transform.header;
    point.point.x = transform.transform.translation.x;
    point.point.y = transform.transform.translation.y;
    point.point.z = transform.transform.translation.z;
    publisher_->publish(point);
  }

  void compare(const std_msgs::msg::Float64 & message)
  {
    if (message.data > get_parameter("limit").as_double() && client_->service_is_ready()) {
      client_->async_send_request(std::make_shared<std_srvs::srv::Trigger::Request>());
    }
  }

  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::shared_ptr<tf2_ros::TransformListener> listener_;
  rclcpp::Publisher<geometry_msgs::msg::PointStamped>::SharedPtr publisher_;
  rclcpp::Subscription<std_msgs::msg::Float64>::SharedPtr subscription_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr client_;
  rclcpp::TimerBase::SharedPtr timer_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Watcher>());
  rclcpp::shutdown();
  return 0;
}
