from setuptools import find_packages, setup

package_name = 'my_robot'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/my_robot', ['urdf/my_robot.urdf', 'rviz/my_robot.rviz']),
        ('share/my_robot/launch', ['launch/my_robot_rviz.launch.py']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='The course',
    maintainer_email='course@example.org',
    description='A wheeled base with a lidar.',
    license='Apache-2.0',
)
