from setuptools import setup

setup(
    name="cart_nodes",
    version="0.1.0",
    packages=["cart_nodes"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/cart_nodes"]),
        ("share/cart_nodes", ["package.xml"]),
    ],
    entry_points={
        "console_scripts": [
            "detector = cart_nodes.detector:main",
            "alarm = cart_nodes.alarm:main",
        ],
    },
)
