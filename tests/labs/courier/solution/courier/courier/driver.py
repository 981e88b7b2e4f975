import math
import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

from courier_interfaces.action import Deliver


class Driver(Node):

    def __init__(self):
        super().__init__('driver')
        self.declare_parameter('top_speed', 0.5)
        self.declare_parameter('nearness', 0.1)
        self.declare_parameter('fixed_frame_id', 'odom')
        self.declare_parameter('moving_frame_id', 'base_link')
        self.top_speed = self.get_parameter('top_speed').value
        self.tolerance = self.get_parameter('nearness').value
        self.fixed_frame_id = self.get_parameter('fixed_frame_id').value
        self.moving_frame_id = self.get_parameter('moving_frame_id').value

        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.server = ActionServer(
            self, Deliver, 'deliver', self.execute,
            cancel_callback=self.on_cancel,
            callback_group=ReentrantCallbackGroup())

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def pose(self):
        t = self.buffer.lookup_transform(self.fixed_frame_id, self.moving_frame_id, Time())
        q = t.transform.rotation
        yaw = 2 * math.atan2(q.z, q.w)
        return t.transform.translation.x, t.transform.translation.y, yaw

    def execute(self, goal_handle):
        goal = goal_handle.request
        feedback = Deliver.Feedback()
        result = Deliver.Result()
        last = None
        while rclpy.ok():
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.publisher.publish(Twist())
                return result
            try:
                x, y, yaw = self.pose()
            except TransformException as error:
                self.get_logger().warning(str(error))
                time.sleep(0.1)
                continue
            if last is not None:
                result.driven += math.hypot(x - last[0], y - last[1])
            last = (x, y)
            distance = math.hypot(goal.x - x, goal.y - y)
            if distance < self.tolerance:
                break
            feedback.remaining = distance
            goal_handle.publish_feedback(feedback)
            heading = math.atan2(goal.y - y, goal.x - x) - yaw
            heading = math.atan2(math.sin(heading), math.cos(heading))
            command = Twist()
            command.angular.z = 1.5 * heading
            command.linear.x = min(self.top_speed, distance) * max(0.0, math.cos(heading))
            self.publisher.publish(command)
            time.sleep(0.1)

        self.publisher.publish(Twist())
        goal_handle.succeed()
        result.reached = True
        return result


def main(args=None):
    rclpy.init(args=args)
    node = Driver()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
