import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Bool


class Detector(Node):
    def __init__(self):
        super().__init__("detector")
        self.declare_parameter("threshold", 0.5)
        self.frame = self.declare_parameter("camera_frame", "camera_link").value
        self.threshold = self.get_parameter("threshold").value
        self.found = self.create_publisher(Bool, "obstacle", 10)
        self.create_subscription(Image, "image", self.on_image, 10)

    def on_image(self, image):
        self.found.publish(Bool(data=image.height > self.threshold))


def main():
    rclpy.init()
    rclpy.spin(Detector())
