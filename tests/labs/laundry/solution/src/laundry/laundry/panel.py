import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from std_msgs.msg import Bool

from laundry_interfaces.action import Wash
from laundry_interfaces.msg import DrumState
from laundry_interfaces.srv import LockDoor


class Panel(Node):
    def __init__(self):
        super().__init__("panel")
        self.declare_parameter("machine", "drum")
        self.declare_parameter("minutes", 60.0)
        self.declare_parameter("program", Wash.Goal.COTTON)
        machine = self.get_parameter("machine").get_parameter_value().string_value
        self.is_locked = False
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(
            DrumState, "{}/state".format(machine), self.on_state, qos_profile_sensor_data
        )
        self.create_subscription(Bool, "door/locked", self.on_locked, latched)
        self.door = self.create_client(LockDoor, "door/lock")
        self.drum = ActionClient(self, Wash, f"{machine}/wash")
        self.starting = self.create_timer(1.0, self.start)

    def start(self):
        if not (self.door.service_is_ready() and self.drum.server_is_ready()):
            return
        self.starting.cancel()
        request = LockDoor.Request()
        request.lock = True
        self.door.call_async(request).add_done_callback(self.on_answer)

    def on_answer(self, future):
        answer = future.result()
        if not answer.done:
            self.get_logger().warning(answer.message)
        goal = Wash.Goal()
        goal.minutes = self.get_parameter("minutes").value
        goal.program = self.get_parameter("program").value
        sent = self.drum.send_goal_async(goal, feedback_callback=self.on_feedback)
        sent.add_done_callback(self.on_goal)

    def on_goal(self, future):
        handle = future.result()
        if handle.accepted:
            handle.get_result_async().add_done_callback(self.on_result)

    def on_result(self, future):
        self.get_logger().info(f"clean: {future.result().result.clean}")

    def on_feedback(self, message):
        self.get_logger().info(f"{message.feedback.progress:.0%}")

    def on_state(self, state):
        if state.is_turning and not self.is_locked:
            self.get_logger().warning("the drum turns, and the door is not locked")
        self.get_logger().info(f"{state.speed:.0f} turns a minute at {state.stamp.sec}")

    def on_locked(self, message):
        self.is_locked = message.data


def main(args=None):
    rclpy.init(args=args)
    node = Panel()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()


if __name__ == "__main__":
    main()
