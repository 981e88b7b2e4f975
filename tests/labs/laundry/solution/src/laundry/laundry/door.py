import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from laundry_interfaces.srv import LockDoor


class Door(Node):
    def __init__(self):
        super().__init__("door")
        self.is_locked = False
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(Bool, "~/locked", latched)
        self.create_service(LockDoor, "~/lock", self.on_lock)
        self.publish()

    def publish(self):
        self.publisher.publish(Bool(data=self.is_locked))

    def on_lock(self, request, response):
        if request.lock == self.is_locked:
            response.done = False
            response.message = "it is already so"
            return response
        self.is_locked = request.lock
        self.publish()
        response.done = True
        return response


def main():
    rclpy.init()
    rclpy.spin(Door())


if __name__ == "__main__":
    main()
