#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "dock_interfaces/action/dock.hpp"
#include "geometry_msgs/msg/transform_stamped.hpp"
#include "geometry_msgs/msg/twist.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "tf2/exceptions.h"
#include "tf2/time.h"
#include "tf2_ros/buffer.h"
#include "tf2_ros/transform_listener.h"

using Dock = dock_interfaces::action::Dock;
using GoalHandle = rclcpp_action::ServerGoalHandle<Dock>;

class DockServer : public rclcpp::Node
{
public:
  DockServer()
  : Node("dock_server")
  {
    using std::placeholders::_1;
    using std::placeholders::_2;
    tolerance_ = declare_parameter<double>("goal_tolerance", 0.05);
    base_frame_ = declare_parameter<std::string>("base_frame", "base_link");
    buffer_ = std::make_unique<tf2_ros::Buffer>(get_clock());
    listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
    publisher_ = create_publisher<geometry_msgs::msg::Twist>("cmd_vel", 10);
    server_ = rclcpp_action::create_server<Dock>(
      this, "dock",
      std::bind(&DockServer::accept, this, _1, _2),
      std::bind(&DockServer::cancel, this, _1),
      std::bind(&DockServer::start, this, _1));
  }

private:
  rclcpp_action::GoalResponse accept(
    const rclcpp_action::GoalUUID &, std::shared_ptr<const Dock::Goal> goal)
  {
    return goal->speed > 0.0 ?
           rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE : rclcpp_action::GoalResponse::REJECT;
  }

  rclcpp_action::CancelResponse cancel(const std::shared_ptr<GoalHandle>)
  {
    return rclcpp_action::CancelResponse::ACCEPT;
  }

  void start(const std::shared_ptr<GoalHandle> goal_handle)
  {
    std::thread{std::bind(&DockServer::execute, this, goal_handle)}.detach();
  }

  void execute(const std::shared_ptr<GoalHandle> goal_handle)
  {
    auto feedback = std::make_shared<Dock::Feedback>();
    auto result = std::make_shared<Dock::Result>();
    const double speed = goal_handle->get_goal()->speed;
    rclcpp::Rate rate(10.0);
    while (rclcpp::ok()) {
      if (goal_handle->is_canceling()) {
        publisher_->publish(geometry_msgs::msg::Twist());
        goal_handle->canceled(result);
        return;
      }
      geometry_msgs::msg::TransformStamped dock;
      try {
        dock = buffer_->lookupTransform(base_frame_, "dock", tf2::TimePointZero);
      } catch (const tf2::TransformException & error) {
        RCLCPP_INFO(get_logger(), "no pose: %s", error.what());
        rate.sleep();
        continue;
      }
      const double x = dock.transform.translation.x;
      const double y = dock.transform.translation.y;
      feedback->remaining = std::hypot(x, y);
      goal_handle->publish_feedback(feedback);
      if (feedback->remaining < tolerance_) {
        break;
      }
      geometry_msgs::msg::Twist command;
      command.linear.x = std::min(speed, feedback->remaining);
      command.angular.z = 2.0 * std::atan2(y, x);
      publisher_->publish(command);
      rate.sleep();
    }
    publisher_->publish(geometry_msgs::msg::Twist());
    result->docked = true;
    result->error = feedback->remaining;
    goal_handle->succeed(result);
  }

  double tolerance_;
  std::string base_frame_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::shared_ptr<tf2_ros::TransformListener> listener_;
  rclcpp::Publisher<geometry_msgs::msg::Twist>::SharedPtr publisher_;
  rclcpp_action::Server<Dock>::SharedPtr server_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<DockServer>());
  rclcpp::shutdown();
  return 0;
}
