from glob import glob

from setuptools import find_packages, setup

setup(
    name="laundry",
    version="1.0.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/laundry"]),
        ("share/laundry", ["package.xml"]),
        ("share/laundry/launch", glob("launch/*")),
        ("share/laundry/config", glob("config/*")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Course staff",
    maintainer_email="staff@example.edu",
    description="A washing machine",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "drum = laundry.drum:main",
            "door = laundry.door:main",
            "panel = laundry.panel:main",
        ],
    },
)
