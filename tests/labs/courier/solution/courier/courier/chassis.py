import math

import rclpy
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class Chassis(Node):
    """Integrates cmd_vel, as a robot without mass would."""

    def __init__(self):
        super().__init__('chassis')
        self.x = 0.0
        self.y = 0.0
        self.theta = 0.0
        self.command = Twist()
        self.period = 0.05
        self.broadcaster = TransformBroadcaster(self)
        self.publisher = self.create_publisher(Odometry, 'odom', 10)
        self.subscription = self.create_subscription(Twist, 'cmd_vel', self.on_command, 10)
        self.timer = self.create_timer(self.period, self.step)

    def on_command(self, msg):
        self.command = msg

    def step(self):
        self.theta += self.command.angular.z * self.period
        self.x += self.command.linear.x * math.cos(self.theta) * self.period
        self.y += self.command.linear.x * math.sin(self.theta) * self.period
        now = self.get_clock().now().to_msg()

        t = TransformStamped()
        t.header.stamp = now
        t.header.frame_id = 'odom'
        t.child_frame_id = 'base_link'
        t.transform.translation.x = self.x
        t.transform.translation.y = self.y
        t.transform.rotation.z = math.sin(self.theta / 2)
        t.transform.rotation.w = math.cos(self.theta / 2)
        self.broadcaster.sendTransform(t)

        odom = Odometry()
        odom.header.stamp = now
        odom.header.frame_id = 'odom'
        odom.child_frame_id = 'base_link'
        odom.pose.pose.position.x = self.x
        odom.pose.pose.position.y = self.y
        odom.pose.pose.orientation = t.transform.rotation
        odom.twist.twist = self.command
        self.publisher.publish(odom)


def main(args=None):
    rclpy.init(args=args)
    node = Chassis()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
