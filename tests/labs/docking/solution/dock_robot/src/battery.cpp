#include <chrono>
#include <memory>
#include <vector>

#include "rcl_interfaces/msg/set_parameters_result.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_lifecycle/lifecycle_node.hpp"
#include "sensor_msgs/msg/battery_state.hpp"

using namespace std::chrono_literals;
using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;

class Battery : public rclcpp_lifecycle::LifecycleNode
{
public:
  Battery()
  : LifecycleNode("battery")
  {
    declare_parameter("capacity", 2.0);
    declare_parameter("low_level", 0.2);
    on_set_ = add_on_set_parameters_callback(
      std::bind(&Battery::check, this, std::placeholders::_1));
  }

  CallbackReturn on_configure(const rclcpp_lifecycle::State &) override
  {
    charge_ = get_parameter("capacity").as_double();
    publisher_ = create_publisher<sensor_msgs::msg::BatteryState>("battery", 10);
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override
  {
    LifecycleNode::on_activate(state);
    timer_ = create_wall_timer(1s, [this]() {publish();});
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_deactivate(const rclcpp_lifecycle::State & state) override
  {
    timer_.reset();
    LifecycleNode::on_deactivate(state);
    return CallbackReturn::SUCCESS;
  }

private:
  void publish()
  {
    sensor_msgs::msg::BatteryState message;
    charge_ -= 0.001;
    message.header.stamp = now();
    message.charge = charge_;
    message.capacity = get_parameter("capacity").as_double();
    message.percentage = message.charge / message.capacity;
    message.present = true;
    if (message.percentage < get_parameter("low_level").as_double()) {
      RCLCPP_WARN(get_logger(), "battery is low");
    }
    publisher_->publish(message);
  }

  rcl_interfaces::msg::SetParametersResult check(const std::vector<rclcpp::Parameter> & parameters)
  {
    rcl_interfaces::msg::SetParametersResult result;
    result.successful = true;
    for (const auto & parameter : parameters) {
      if (parameter.get_name() == "low_level" && parameter.as_double() > 1.0) {
        result.successful = false;
        result.reason = "low_level is a share of the capacity";
      }
    }
    return result;
  }

  double charge_ = 0.0;
  rclcpp_lifecycle::LifecyclePublisher<sensor_msgs::msg::BatteryState>::SharedPtr publisher_;
  rclcpp::TimerBase::SharedPtr timer_;
  OnSetParametersCallbackHandle::SharedPtr on_set_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<Battery>();
  rclcpp::spin(node->get_node_base_interface());
  rclcpp::shutdown();
  return 0;
}
