from glob import glob

from setuptools import setup

setup(
    name="hallway",
    version="1.0.0",
    packages=["hallway"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/hallway"]),
        ("share/hallway", ["package.xml"]),
        ("share/hallway/launch", glob("launch/*")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Course",
    maintainer_email="course@example.org",
    description="A robot that stops before walls",
    license="MIT",
    entry_points={
        "console_scripts": [
            "eye = hallway.eye:main",
            "driver = hallway.driver:main",
            "odometry = hallway.odometry:main",
        ],
    },
)
