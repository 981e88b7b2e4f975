#!/usr/bin/env python3
"""Publish how bright the picture of the wrist camera is."""

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image
from std_msgs.msg import Float32


class LightMeter(Node):
    """Takes the mean of all bytes of a picture."""

    def __init__(self):
        super().__init__("light_meter")
        self.brightness = self.create_publisher(Float32, "brightness", 10)
        self.create_subscription(Image, "camera/image", self.measure, qos_profile_sensor_data)

    def measure(self, image):
        data = bytes(image.data)
        self.brightness.publish(Float32(data=sum(data) / max(len(data), 1) / 255))


def main():
    rclpy.init()
    rclpy.spin(LightMeter())
    rclpy.shutdown()


if __name__ == "__main__":
    main()
