import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32
from std_srvs.srv import Trigger


class Eye(Node):
    """Publishes the distance of what is nearest, and stops the robot before it."""

    def __init__(self):
        super().__init__("eye")
        self.nearest = self.create_publisher(Float32, "nearest", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)
        self.stop = self.create_client(Trigger, "stop")

    def on_scan(self, message):
        nearest = min(message.ranges)
        self.nearest.publish(Float32(data=nearest))
        if nearest < 0.2 and self.stop.service_is_ready():
            self.stop.call_async(Trigger.Request())


def main():
    rclpy.init()
    rclpy.spin(Eye())
