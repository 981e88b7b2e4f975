import time

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import qos_profile_sensor_data

from laundry_interfaces.action import Wash
from laundry_interfaces.msg import DrumState


class Drum(LifecycleNode):
    """Turns while it washes; its topics and its action are below its own name."""

    def __init__(self):
        super().__init__("drum")
        self.declare_parameter("period", 1.0)
        self.declare_parameter("top_speed", 1000.0)
        self.speed = 0.0
        self.publisher = None
        self.timer = None
        self.server = None

    def on_configure(self, state):
        self.publisher = self.create_lifecycle_publisher(
            DrumState, f"{self.get_name()}/state", qos_profile_sensor_data
        )
        self.server = ActionServer(
            self,
            Wash,
            self.get_name() + "/wash",
            execute_callback=self.wash,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
            callback_group=ReentrantCallbackGroup(),
        )
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.timer = self.create_timer(self.get_parameter("period").value, self.publish_state)
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.destroy_timer(self.timer)
        return super().on_deactivate(state)

    def publish_state(self):
        state = DrumState()
        state.stamp = self.get_clock().now().to_msg()
        state.speed = self.speed
        state.is_turning = self.speed > 0.0
        self.publisher.publish(state)

    def on_goal(self, request):
        if request.program not in (Wash.Goal.COTTON, Wash.Goal.WOOL):
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def wash(self, goal_handle):
        steps = max(1, int(goal_handle.request.minutes))
        self.speed = self.get_parameter("top_speed").value
        for step in range(steps):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return self.stopped(clean=False)
            time.sleep(1.0)
            goal_handle.publish_feedback(Wash.Feedback(progress=(step + 1) / steps))
        goal_handle.succeed()
        return self.stopped(clean=True)

    def stopped(self, clean):
        self.speed = 0.0
        result = Wash.Result()
        result.clean = clean
        return result


def main(args=None):
    rclpy.init(args=args)
    node = Drum()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
