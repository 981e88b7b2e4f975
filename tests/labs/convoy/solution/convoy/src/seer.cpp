#include <functional>
#include <memory>

#include "geometry_msgs/msg/point_stamped.hpp"
#include "geometry_msgs/msg/transform_stamped.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_components/register_node_macro.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "std_srvs/srv/set_bool.hpp"
#include "tf2_ros/transform_broadcaster.h"

namespace convoy
{

class Seer : public rclcpp::Node
{
public:
  explicit Seer(const rclcpp::NodeOptions & options)
  : Node("seer", options)
  {
    broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
    point_ = create_publisher<geometry_msgs::msg::PointStamped>("leader", 10);
    follow_ = create_client<std_srvs::srv::SetBool>("follow");
    image_ = create_subscription<sensor_msgs::msg::Image>(
      "/camera/image", rclcpp::SensorDataQoS(),
      std::bind(&Seer::see, this, std::placeholders::_1));
  }

private:
  void see(const sensor_msgs::msg::Image & image)
  {
    geometry_msgs::msg::TransformStamped transform;
    transform.header.stamp = image.header.stamp;
    transform.header.frame_id = "camera";
    transform.child_frame_id = "leader";
    transform.transform.translation.z = 1.0;
    transform.transform.rotation.w = 1.0;
    broadcaster_->sendTransform(transform);
    geometry_msgs::msg::PointStamped point;
    point.header = transform.header;
    point.point.z = 1.0;
    point_->publish(point);
    if (!is_asked_ && follow_->service_is_ready()) {
      auto request = std::make_shared<std_srvs::srv::SetBool::Request>();
      request->data = true;
      follow_->async_send_request(request);
      is_asked_ = true;
    }
  }

  bool is_asked_ = false;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  rclcpp::Publisher<geometry_msgs::msg::PointStamped>::SharedPtr point_;
  rclcpp::Client<std_srvs::srv::SetBool>::SharedPtr follow_;
  rclcpp::Subscription<sensor_msgs::msg::Image>::SharedPtr image_;
};

}  // namespace convoy

RCLCPP_COMPONENTS_REGISTER_NODE(convoy::Seer)
