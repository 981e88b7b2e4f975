#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "geometry_msgs/msg/transform_stamped.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_components/register_node_macro.hpp"
#include "std_msgs/msg/float64.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "tf2_ros/transform_broadcaster.h"

using namespace std::chrono_literals;

namespace beacon
{

class Orbiter : public rclcpp::Node
{
public:
  explicit Orbiter(const rclcpp::NodeOptions & options)
  : Node("orbiter", options)
  {
    radius_ = declare_parameter("radius", 1.0);
    period_ = declare_parameter("period", 8.0);
    frame_id_ = declare_parameter("frame_id", "world");
    child_frame_id_ = declare_parameter("child_frame_id", "beacon_link");
    start_ = now();

    broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
    publisher_ = create_publisher<std_msgs::msg::Float64>("angle", rclcpp::SensorDataQoS());
    service_ = create_service<std_srvs::srv::Trigger>(
      "reset", std::bind(&Orbiter::reset, this, std::placeholders::_1, std::placeholders::_2));
    timer_ = create_wall_timer(50ms, std::bind(&Orbiter::step, this));
  }

private:
  void step()
  {
    const double turns = (now() - start_).seconds() / period_;
    const double angle = 2.0 * M_PI * (turns - std::floor(turns));

    geometry_msgs::msg::TransformStamped transform;
    transform.header.stamp = now();
    transform.header.frame_id = frame_id_;
    transform.child_frame_id = child_frame_id_;
    transform.transform.translation.x = radius_ * std::cos(angle);
    transform.transform.translation.y = radius_ * std::sin(angle);
    transform.transform.rotation.x = 0.0;
    transform.transform.rotation.y = 0.0;
    transform.transform.rotation.z = 0.0;
    transform.transform.rotation.w = 1.0;
    broadcaster_->sendTransform(transform);

    std_msgs::msg::Float64 message;
    message.data = angle;
    publisher_->publish(message);
  }

  void reset(
    const std::shared_ptr<std_srvs::srv::Trigger::Request>,
    std::shared_ptr<std_srvs::srv::Trigger::Response> response)
  {
    start_ = now();
    response->success = true;
    response->message = "the circle starts again";
  }

  double radius_;
  double period_;
  std::string frame_id_;
  std::string child_frame_id_;
  rclcpp::Time start_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  rclcpp::Publisher<std_msgs::msg::Float64>::SharedPtr publisher_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr service_;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace beacon

RCLCPP_COMPONENTS_REGISTER_NODE(beacon::Orbiter)
