import rclpy
from ferry_msgs.action import Lift
from ferry_msgs.msg import Load
from ferry_msgs.srv import Tare
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener


class Pilot(Node):
    def __init__(self):
        super().__init__('deck_pilot')
        self.declare_parameter('cruise_speed', 0.5)
        self.mass = 0.0
        self.create_subscription(Load, 'load', self.on_load, 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.drive = self.create_publisher(TwistStamped, 'cmd_vel', 10)
        self.tare = self.create_client(Tare, 'tare')
        self.lift = ActionClient(self, Lift, 'lift')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(0.1, self.tick)

    def on_load(self, message):
        self.mass = message.mass

    def on_odometry(self, odometry):
        self.speed = odometry.twist.twist.linear.x

    def tick(self):
        if not self.buffer.can_transform('odom', 'base_link', Time()):
            return
        command = TwistStamped()
        command.header.stamp = self.get_clock().now().to_msg()
        command.twist.linear.x = self.get_parameter('cruise_speed').value
        self.drive.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Pilot())


if __name__ == '__main__':
    main()
