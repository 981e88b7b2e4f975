import rclpy
from cart_msgs.msg import Obstacle
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Filter(Node):
    def __init__(self):
        super().__init__("filter")
        self.declare_parameter("min_range", 0.1)
        self.declare_parameter("max_range", 10.0)
        self.obstacles = self.create_publisher(Obstacle, "obstacle", 10)
        self.create_subscription(LaserScan, "scan_in", self.on_scan, 10)

    def on_scan(self, scan):
        low = self.get_parameter("min_range").value
        high = self.get_parameter("max_range").value
        near = [value for value in scan.ranges if low < value < high]
        if near:
            message = Obstacle()
            message.header.frame_id = "lidar_link"
            message.distance = min(near)
            self.obstacles.publish(message)


def main():
    rclpy.init()
    node = Filter()
    rclpy.spin(node)
    rclpy.shutdown()
