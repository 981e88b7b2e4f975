from setuptools import setup

package_name = "cart_nodes"

setup(
    name=package_name,
    version="0.1.0",
    packages=[package_name],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={
        "console_scripts": [
            "filter = cart_nodes.filter:main",
            "driver = cart_nodes.driver:main",
        ],
    },
)
