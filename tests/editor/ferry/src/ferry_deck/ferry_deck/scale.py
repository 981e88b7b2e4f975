import rclpy
from ferry_msgs.msg import Load
from ferry_msgs.srv import Tare
from rclpy.node import Node


class Scale(Node):
    def __init__(self):
        super().__init__('deck_scale')
        self.declare_parameter('tare_offset', 0.0)
        self.declare_parameter('rate', 10.0)
        self.declare_parameter('box_frame', 'deck_link')
        self.offset = self.get_parameter('tare_offset').value
        self.publisher = self.create_publisher(Load, 'load', 10)
        self.create_service(Tare, 'tare', self.on_tare)
        self.create_timer(1.0 / self.get_parameter('rate').value, self.tick)

    def on_tare(self, request, response):
        self.offset = request.offset
        response.success = True
        return response

    def tick(self):
        load = Load()
        load.header.stamp = self.get_clock().now().to_msg()
        load.header.frame_id = 'deck_link'
        load.mass = 12.0 - self.offset
        self.publisher.publish(load)


def main():
    rclpy.init()
    rclpy.spin(Scale())


if __name__ == '__main__':
    main()
