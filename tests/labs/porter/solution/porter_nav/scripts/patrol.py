#!/usr/bin/env python3
"""Drive through the stops of a patrol."""

import math

import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult


class Patrol(BasicNavigator):
    """Asks Nav2 to follow the stops, some rounds."""

    def __init__(self):
        super().__init__(node_name="patrol")
        self.declare_parameter("rounds", 1)
        self.declare_parameter("stops", [0.0, 0.0, 0.0])

    def stop(self, x, y, yaw):
        """Return a stop as a pose in the map."""
        pose = PoseStamped()
        pose.header.frame_id = "map"
        pose.header.stamp = self.get_clock().now().to_msg()
        pose.pose.position.x = x
        pose.pose.position.y = y
        pose.pose.orientation.z = math.sin(yaw / 2)
        pose.pose.orientation.w = math.cos(yaw / 2)
        return pose

    def drive(self):
        """Drive all rounds."""
        numbers = list(self.get_parameter("stops").value)
        for _ in range(self.get_parameter("rounds").value):
            stops = [self.stop(*numbers[i:i + 3]) for i in range(0, len(numbers), 3)]
            self.followWaypoints(stops)
            while not self.isTaskComplete():
                pass
            if self.getResult() != TaskResult.SUCCEEDED:
                self.error("the round was not completed")
                return


def main():
    rclpy.init()
    patrol = Patrol()
    patrol.waitUntilNav2Active()
    patrol.drive()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
