import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node

from courier_interfaces.action import Deliver


class Planner(Node):

    def __init__(self):
        super().__init__('planner')
        self.declare_parameter('stops', [1.0, 0.0])
        values = self.get_parameter('stops').value
        self.stops = list(zip(values[0::2], values[1::2]))
        self.client = ActionClient(self, Deliver, 'deliver')

    def start(self):
        self.client.wait_for_server()
        self.send_next()

    def send_next(self):
        if not self.stops:
            self.get_logger().info('all stops done')
            return
        x, y = self.stops.pop(0)
        goal = Deliver.Goal()
        goal.x = x
        goal.y = y
        future = self.client.send_goal_async(goal, feedback_callback=self.on_feedback)
        future.add_done_callback(self.on_accepted)

    def on_feedback(self, message):
        self.get_logger().info(f'{message.feedback.remaining:.2f} m to go')

    def on_accepted(self, future):
        handle = future.result()
        if not handle.accepted:
            self.get_logger().error('the goal was rejected')
            return
        handle.get_result_async().add_done_callback(self.on_result)

    def on_result(self, future):
        result = future.result().result
        self.get_logger().info(f'reached: {result.reached}, {result.driven:.2f} m')
        self.send_next()


def main(args=None):
    rclpy.init(args=args)
    node = Planner()
    try:
        node.start()
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
