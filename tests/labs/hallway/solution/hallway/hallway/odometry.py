import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class OdometryNode(Node):
    """Publishes where the wheels say that the robot is."""

    def __init__(self):
        super().__init__("odometry")
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Odometry, "wheel_odom", self.on_odometry, 10)

    def on_odometry(self, message):
        transform = TransformStamped()
        transform.header.stamp = message.header.stamp
        transform.header.frame_id = "odom"
        transform.child_frame_id = "base_link"
        transform.transform.translation.x = message.pose.pose.position.x
        transform.transform.translation.y = message.pose.pose.position.y
        transform.transform.rotation = message.pose.pose.orientation
        self.broadcaster.sendTransform(transform)


def main():
    rclpy.init()
    rclpy.spin(OdometryNode())
