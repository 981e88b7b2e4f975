import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Alarm(Node):
    def __init__(self):
        super().__init__("alarm")
        self.declare_parameter("volume", 5)
        self.create_subscription(Bool, "obstacle", self.on_obstacle, 10)

    def on_obstacle(self, message):
        if message.data and self.get_parameter("volume").value > 0:
            self.get_logger().warning("obstacle")


def main():
    rclpy.init()
    rclpy.spin(Alarm())
