#include <functional>
#include <memory>

#include "geometry_msgs/msg/point_stamped.hpp"
#include "geometry_msgs/msg/twist.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_components/register_node_macro.hpp"
#include "std_srvs/srv/set_bool.hpp"

namespace convoy
{

class Follower : public rclcpp::Node
{
public:
  explicit Follower(const rclcpp::NodeOptions & options)
  : Node("follower", options)
  {
    command_ = create_publisher<geometry_msgs::msg::Twist>("cmd_vel", 10);
    service_ = create_service<std_srvs::srv::SetBool>(
      "follow", std::bind(&Follower::follow, this, std::placeholders::_1, std::placeholders::_2));
    point_ = create_subscription<geometry_msgs::msg::PointStamped>(
      "leader", 10, std::bind(&Follower::drive, this, std::placeholders::_1));
  }

private:
  void drive(const geometry_msgs::msg::PointStamped & point)
  {
    geometry_msgs::msg::Twist command;
    if (is_following_) {
      command.linear.x = 0.5 * point.point.z;
    }
    command_->publish(command);
  }

  void follow(
    const std::shared_ptr<std_srvs::srv::SetBool::Request> request,
    std::shared_ptr<std_srvs::srv::SetBool::Response> response)
  {
    is_following_ = request->data;
    response->success = true;
  }

  bool is_following_ = false;
  rclcpp::Publisher<geometry_msgs::msg::Twist>::SharedPtr command_;
  rclcpp::Service<std_srvs::srv::SetBool>::SharedPtr service_;
  rclcpp::Subscription<geometry_msgs::msg::PointStamped>::SharedPtr point_;
};

}  // namespace convoy

RCLCPP_COMPONENTS_REGISTER_NODE(convoy::Follower)
