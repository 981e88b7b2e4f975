import rclpy
from cart_msgs.msg import Obstacle
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.commands = self.create_publisher(TwistStamped, "/cmd_vel", 10)
        self.create_subscription(Obstacle, "obstacle", self.on_obstacle, 10)

    def on_obstacle(self, obstacle):
        command = TwistStamped()
        command.header.frame_id = "base_link"
        command.twist.linear.x = 0.1 if obstacle.distance > 1.0 else 0.0
        self.commands.publish(command)


def main():
    rclpy.init()
    node = Driver()
    rclpy.spin(node)
    rclpy.shutdown()
