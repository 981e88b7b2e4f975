#!/usr/bin/env python3
"""Drive in a circle."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class DriveCircle(Node):
    def __init__(self):
        super().__init__("drive_circle")
        self.declare_parameter("speed", 0.2)
        self.declare_parameter("turn_rate", 0.5)
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.send)

    def send(self):
        command = Twist()
        command.linear.x = self.get_parameter("speed").value
        command.angular.z = self.get_parameter("turn_rate").value
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(DriveCircle())


if __name__ == "__main__":
    main()
