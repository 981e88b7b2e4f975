from pathlib import Path

from setuptools import find_packages, setup

package_name = 'my_robot'
share = f'share/{package_name}'

data_files = [
    ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
    (share, ['package.xml']),
]
for folder in ('urdf', 'rviz'):
    data_files.append((share, [str(path) for path in sorted(Path(folder).iterdir())]))
data_files += [(f'{share}/launch', [str(path) for path in Path('launch').glob('*.launch.py')])]

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=data_files,
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='The course',
    maintainer_email='course@example.org',
    description='A wheeled base with a lidar.',
    license='Apache-2.0',
)
