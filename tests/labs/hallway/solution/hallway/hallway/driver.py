import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Float32
from std_srvs.srv import Trigger


class Driver(Node):
    """Drives straight ahead while nothing is near."""

    def __init__(self):
        super().__init__("driver")
        self.command = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Float32, "nearest", self.on_nearest, 10)
        self.create_service(Trigger, "stop", self.on_stop)
        self.is_stopped = False

    def on_nearest(self, message):
        command = Twist()
        if message.data > 0.5 and not self.is_stopped:
            command.linear.x = 0.2
        self.command.publish(command)

    def on_stop(self, request, response):
        self.is_stopped = True
        response.success = True
        return response


def main():
    rclpy.init()
    rclpy.spin(Driver())
