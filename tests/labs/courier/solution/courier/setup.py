from glob import glob

from setuptools import find_packages, setup

package_name = 'courier'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
        ('share/' + package_name + '/config', glob('config/*.yaml')),
        ('share/' + package_name + '/rviz', glob('rviz/*.rviz')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Student',
    maintainer_email='student@example.org',
    description='Drives to stops',
    license='MIT',
    entry_points={
        'console_scripts': [
            'chassis = courier.chassis:main',
            'driver = courier.driver:main',
            'planner = courier.planner:main',
        ],
    },
)
